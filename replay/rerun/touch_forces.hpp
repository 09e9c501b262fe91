#pragma once

#include <span>
#include <vector>

#include "common/geometry.hpp"
#include "simulation/step/step_record.hpp"

namespace irdm::replay {

/// What another body, or another part of it, did to an object at one contact, on the object as a
/// whole.
struct TouchForce {
  Vector3 force = Vector3::Zero();  ///< on the object [N], W
  Vector3 arm = Vector3::Zero();    ///< from the centre of mass half-way through the step [m], W
  const BodyContactRecord* contact = nullptr;
  bool first = true;  ///< the sample of the contact is this object's
};

/// Those of one object in a recorded step.
/// @param number of the object  @param recorded its step, with start and end as they were recorded
/// @param contacts of all objects; must outlive the forces
void find_touch_forces(int number, const ObjectRecord& recorded,
                       std::span<const BodyContactRecord> contacts,
                       std::vector<TouchForce>& forces);

}  // namespace irdm::replay
