#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "simulation/contact/contact_patch.hpp"
#include "simulation/engine/response_engine.hpp"

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

}  // namespace irdm
