#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "simulation/contact/contact_patch.hpp"
#include "simulation/contact/contact_sampling.hpp"
#include "simulation/contact/pressure_mask.hpp"
#include "simulation/engine/response_engine.hpp"
#include "simulation/step/simulation_config.hpp"
#include "simulation/step/step_record.hpp"

namespace irdm {

/// The forces of one step spread over nodes. Memory is taken once; real-time safe afterwards.
class NodalForces {
 public:
  explicit NodalForces(std::size_t capacity) : forces_(capacity) {}

  void clear() noexcept { count_ = 0; }
  /// What does not fit is left out; nobody asks for more than the capacity.
  void add(int node, const Vector3& force) noexcept {
    if (count_ < forces_.size()) forces_[count_++] = {node, force};
  }
  /// Spreads a force on the object [N, B] over the nodes of its patch.
  void add(const ContactPatch& patch, const Vector3& force) noexcept {
    for (std::size_t i = 0; i < static_cast<std::size_t>(patch.count); ++i) {
      add(patch.nodes[i], patch.weights[i] * force);
    }
  }
  std::span<const NodalForce> view() const noexcept { return {forces_.data(), count_}; }

 private:
  std::vector<NodalForce> forces_;
  std::size_t count_ = 0;
};

/// Forces on many patches of one object, added up node by node. Memory is taken once; real-time
/// safe afterwards.
class NodalSums {
 public:
  explicit NodalSums(int node_count)
      : sums_(static_cast<std::size_t>(node_count), Vector3::Zero()),
        used_(static_cast<std::size_t>(node_count), false) {
    nodes_.reserve(sums_.size());
  }

  void clear() noexcept;
  /// Spreads a force [N, B] over the nodes of a patch.
  void add(const SurfacePatch& patch, const Vector3& force) noexcept;
  /// To the forces of a step, each node once.
  void add_to(NodalForces& forces) const noexcept;

 private:
  std::vector<Vector3> sums_;
  std::vector<bool> used_;
  std::vector<int> nodes_;  ///< with a force, in the order in which they came
};

/// Adds what a contact between bodies does to one of them: to the first object of the record, or to
/// the other. Real-time safe. @param halfway of that object, B to W
void add_body_contact(const BodyContactRecord& contact, bool first, const ContactSampling& sampling,
                      const Quaternion& halfway, NodalSums& sums) noexcept;

/// The nodal forces of recorded steps: what the force step gave to its engine, to the bit. One
/// thread; real-time safe after construction.
class RecordedForces {
 public:
  /// @param surface of object `number` of the scene; must outlive this object
  RecordedForces(const SimulationConfig& config, std::size_t number, const RestSurface& surface);

  /// Valid until the next call.
  /// @param contacts between bodies, of the whole step
  std::span<const NodalForce> of(const ObjectRecord& record,
                                 std::span<const BodyContactRecord> contacts) noexcept;
  /// The same for one that was entered late.
  std::span<const NodalForce> of(const LateForce& late) noexcept;

 private:
  int number_;
  std::vector<PressureMask> masks_;
  std::unique_ptr<ContactSampling> sampling_;  ///< null: it touches no other body
  ContactPatch patch_;
  NodalForces forces_;
  NodalSums sums_;
};

}  // namespace irdm
