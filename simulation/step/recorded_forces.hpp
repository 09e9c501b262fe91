#pragma once

#include <vector>

#include "simulation/contact/pressure_mask.hpp"
#include "simulation/step/nodal_forces.hpp"
#include "simulation/step/step_record.hpp"

namespace irdm {

/// The nodal forces of recorded steps: what the force step gave to its engine, to the bit. One
/// thread; real-time safe after construction.
class RecordedForces {
 public:
  /// @param surface must outlive this object
  /// @param radii of the styluses' fingertips [m]; kMaxStyluses at most
  RecordedForces(const RestSurface& surface, const std::vector<double>& radii);

  /// Valid until the next call.
  std::span<const NodalForce> of(const ObjectRecord& record) noexcept;
  /// The same for one that was entered late.
  std::span<const NodalForce> of(const LateForce& late) noexcept;

 private:
  std::vector<PressureMask> masks_;
  ContactPatch patch_;
  NodalForces forces_;
};

}  // namespace irdm
