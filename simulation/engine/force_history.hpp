#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "simulation/engine/response_engine.hpp"

namespace irdm {

/// The last T steps of forces, kept node by node: only nodes on which a force acted within the last
/// T steps are active, and of each only the span of steps in which it did is looked at.
///
/// Each series runs backward in time and is written twice, T apart, so that f[k], f[k-1], ...
/// f[k-T+1] are always consecutive numbers. Real-time safe after construction; one thread.
class ForceHistory {
 public:
  ForceHistory(int nodes, int steps);

  /// Ends a step: f[k] becomes `forces` (several on one node add up), older ones move back by one.
  void push(std::span<const NodalForce> forces) noexcept;
  /// Adds forces to those of the step `age` steps before the last one; false, and nothing added,
  /// where that is before the first step or no longer kept.
  bool add_delayed_force(std::span<const NodalForce> forces, int age) noexcept;
  void clear() noexcept;
  /// State, in or out (StateArchive).
  void archive(StateArchive& state);

  /// Nodes with a force within the last T steps.
  std::span<const int> active() const noexcept { return active_; }

  /// Whether a node is one of them.
  bool holds(int node) const noexcept { return first_[static_cast<std::size_t>(node)] >= 0; }

  /// Force on an active node along an axis over the span of ages in which it may differ from zero.
  struct Series {
    const double* force;  ///< force[i] acted `first_age + i` steps before the newest step
    int first_age;        ///< 0 is the newest step
    int count;
  };
  Series series(int node, int axis) const noexcept;

  /// The factor by which the forces on an active node differ from those on another over all ages,
  /// if they differ by nothing else but rounding; otherwise 0.
  double multiple(int node, int of) const noexcept;

 private:
  double* slot(int node, int axis) noexcept {
    return values_.data() + (3 * static_cast<std::size_t>(node) + static_cast<std::size_t>(axis)) *
                                2 * static_cast<std::size_t>(steps_);
  }

  int steps_;
  int head_ = 0;                     ///< where the newest step stands, 0 <= head_ < steps_
  std::int64_t clock_ = -1;          ///< number of the newest step
  std::vector<double> values_;       ///< (node, axis, 2 T)
  std::vector<std::int64_t> first_;  ///< step in which a node became active; -1: not active
  std::vector<std::int64_t> last_;   ///< step in which a force last acted on it
  std::vector<int> active_;
};

/// The forces on one degree of freedom over some consecutive ages.
struct NonzeroInterval {
  std::size_t column = 0;  ///< 3 node + axis
  std::size_t first_age = 0;
  std::size_t count = 0;
  const double* force = nullptr;  ///< force[i] acted `first_age + i` steps before the newest step
};

/// Silences shorter than this are read through: less than a page of R.
inline constexpr std::size_t kSilence = 64;

/// All of a history's forces, node by node and axis by axis, without the silences: directions in
/// which nothing acted, and steps between touches. Points into the history. Takes memory.
std::vector<NonzeroInterval> nonzero_intervals(const ForceHistory& history);

}  // namespace irdm
