#pragma once

#include "simulation/engine/followed_nodes.hpp"

namespace irdm {

/// The convolution of a response with the forces until now, equation (10). Nodes that are followed
/// cost little, any other is summed then and there. What a step may see of it and what is foreseen
/// are followed apart: a step's last bits do not depend on whether somebody looked ahead. Real-time
/// safe after construction; one thread.
template <typename Columns>
class RunningConvolution {
 public:
  /// @param columns ResidentColumns, or HeldColumns, of which those of whole nodes count; must
  /// outlive it  @param sources nodes that forces act on
  RunningConvolution(Columns& columns, int sources);
  RunningConvolution(const RunningConvolution&) = delete;
  RunningConvolution& operator=(const RunningConvolution&) = delete;

  /// A node is asked for now, and it may be in the coming step too. Tells add_coming() only.
  void follow(int node) noexcept;
  /// Adds what the forces do to a node by the end of the coming step [m].
  void add_coming(int node, Vector3& u) const noexcept;

  /// A node's next n steps are looked at, now and it may be in the coming steps too.
  void foresee(int node, int n) noexcept;
  /// Adds what the forces do by the end of the n-th coming step [m], n from 1 on.
  void add_foreseen(int node, int n, Vector3& u) const noexcept;

  /// As ForceHistory's; the columns follow it.
  void push(std::span<const NodalForce> forces) noexcept;
  void add_past(std::span<const NodalForce> forces, int age) noexcept;
  void clear() noexcept;
  const ForceHistory& history() const noexcept { return history_; }
  /// Columns became whole of a node with a past: what was kept lacks it.
  void keep_nothing() noexcept;

 private:
  Columns& columns_;
  ForceHistory history_;
  FollowedNodes<Columns> stepped_;
  FollowedNodes<Columns> foreseen_;
};

}  // namespace irdm
