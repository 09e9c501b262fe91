#pragma once

#include "server/engine/followed_nodes.hpp"

namespace irdm {

/// The convolution of a response with the forces until now, equation (10). Nodes that are followed
/// cost little, any other is summed then and there. What a step may see of it and what is foreseen
/// are followed apart: a step's last bits do not depend on whether somebody looked ahead. Real-time
/// safe after construction but for add_all(); one thread.
template <typename Number>
class RunningConvolution {
 public:
  /// @param columns without values: nothing is ever added  @param sources nodes that forces act on
  RunningConvolution(const ResidentColumns<Number>& columns, int sources);

  /// A node is asked for now, and it may be in the coming step too. Tells add_coming() only.
  void follow(int node) noexcept;
  /// Adds what the forces do to a node by the end of the coming step [m].
  void add_coming(int node, Vector3& u) const noexcept;

  /// A node's next n steps are looked at, now and it may be in the coming steps too.
  void foresee(int node, int n) noexcept;
  /// Adds what the forces do by the end of the n-th coming step [m], n from 1 on.
  void add_foreseen(int node, int n, Vector3& u) const noexcept;

  /// Adds the displacement of all nodes at the end of the last step (OpenMP).
  void add_all(Points& u) const { columns_.add_all(history_, u); }

  /// As ForceHistory's.
  void push(std::span<const NodalForce> forces) noexcept;
  void add_past(std::span<const NodalForce> forces, int age) noexcept;
  void clear() noexcept;

 private:
  ResidentColumns<Number> columns_;
  ForceHistory history_;
  FollowedNodes<Number> stepped_;
  FollowedNodes<Number> foreseen_;
};

}  // namespace irdm
