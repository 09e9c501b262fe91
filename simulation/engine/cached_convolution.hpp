#pragma once

#include "simulation/engine/prediction_cache.hpp"

namespace irdm {

/// The convolution of a response with the forces until now, equation (10). Nodes that are cached
/// cost little, any other is summed then and there. What a step may see of it and what is predicted
/// are cached apart: a step's last bits do not depend on whether somebody looked ahead. Real-time
/// safe after construction; one thread.
template <typename Columns>
class CachedConvolution {
 public:
  /// @param columns ResidentColumns, or PinnedColumns, of which those of whole nodes count; must
  /// outlive it  @param sources nodes that forces act on
  CachedConvolution(Columns& columns, int sources);
  CachedConvolution(const CachedConvolution&) = delete;
  CachedConvolution& operator=(const CachedConvolution&) = delete;

  /// A node is asked for now, and it may be in the coming step too. Tells add_coming() only.
  void cache_node(int node) noexcept;
  /// Adds what the forces do to a node by the end of the coming step [m].
  void add_coming(int node, Vector3& u) const noexcept;

  /// A node's next n steps are looked at, now and it may be in the coming steps too.
  void predict_horizon(int node, int n) noexcept;
  /// Adds what the forces do by the end of the n-th coming step [m], n from 1 on.
  void add_ahead(int node, int n, Vector3& u) const noexcept;

  /// As ForceHistory's; the columns follow it.
  void push(std::span<const NodalForce> forces) noexcept;
  void add_delayed_force(std::span<const NodalForce> forces, int age) noexcept;
  void clear() noexcept;
  const ForceHistory& history() const noexcept { return history_; }
  /// Columns became whole of a node with a past: what was kept lacks it.
  void keep_nothing() noexcept;

 private:
  Columns& columns_;
  ForceHistory history_;
  PredictionCache<Columns> stepped_;
  PredictionCache<Columns> horizon_cache_;
};

}  // namespace irdm
