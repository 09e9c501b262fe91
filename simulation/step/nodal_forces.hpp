#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "simulation/contact/contact_patch.hpp"
#include "simulation/contact/pressure_mask.hpp"
#include "simulation/engine/response_engine.hpp"
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
