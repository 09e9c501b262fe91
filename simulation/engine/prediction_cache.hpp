#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/contact/contact_model.hpp"
#include "simulation/engine/force_history.hpp"
#include "simulation/engine/kernels.hpp"
#include "simulation/engine/pinned_columns.hpp"

namespace irdm {

/// What the forces until now do at nodes that are asked for step after step, kept for some steps
/// ahead. A new force is added to it, a late one too, with the few steps of R that this takes. Only
/// what lies further ahead is summed over the whole history, kStepsAhead steps in one go, for which
/// R is read once and not in each of them; nodes take their turns. Forces that keep in proportion,
/// those of a contact that sticks, are convolved once, with what R says of all of them. Equal to
/// Columns::convolve() but for rounding. Real-time safe after construction; one thread.
template <typename Columns>
class PredictionCache {
 public:
  /// @param columns ResidentColumns, or PinnedColumns, of which those of whole nodes count; must
  /// outlive it. Of no size: nothing is ever kept
  explicit PredictionCache(const Columns& columns);

  /// Keeps a node's next n steps if it was cached in a step before, too.
  void cache_node(const ForceHistory& history, int node, int n) noexcept;
  /// Adds what a node does by the end of the n-th coming step [m], n from 1 on, if that is kept.
  bool add_coming(int node, int n, Vector3& u) const noexcept;

  /// As ForceHistory's.
  void push(std::span<const NodalForce> forces) noexcept;
  void add_delayed_force(std::span<const NodalForce> forces, int age) noexcept;
  /// Keeps nothing any more.
  void clear() noexcept;
  /// State, in or out (StateArchive): sums differ in rounding by when they were begun.
  void archive(StateArchive& state);

 private:
  using Number = typename Columns::Value;
  static constexpr int kMost = 256;
  /// Steps after which a node is forgotten.
  static constexpr std::int64_t kPatience = 8;
  static constexpr int kBeyond = 8;  ///< numbers that add_effect() may write past the last one
  static constexpr int kRoom = 2 * (kMaxHorizon + 2 * static_cast<int>(kStepsAhead));

  /// Displacements in the coming steps: that of the n-th at begin + n - 1.
  struct Cached {
    int node = 0;
    int begin = 0;
    int length = 0;
    bool begun = false;
    std::int64_t first = 0;  ///< step in which it was cached
    std::int64_t last = 0;
    std::array<std::array<double, kRoom + kBeyond>, 3> coming;
  };

  /// Nodes whose forces always were the first one's times a factor.
  static constexpr std::size_t kMostTogether = 32;
  struct Together {
    std::size_t count = 0;
    std::array<int, kMostTogether> nodes;
    std::array<double, kMostTogether> factors;
  };

  Cached* find(int node) noexcept;
  void extend(const ForceHistory& history, Cached& cached) noexcept;
  Together together(const ForceHistory& history, std::span<const int> sources) const noexcept;
  void add_ahead_of(const ForceHistory& history, const Together& sources, Cached& cached) noexcept;
  void add(std::span<const NodalForce> forces, int age) noexcept;
  void forget_idle() noexcept;

  const Columns& columns_;
  std::vector<Cached> cached_;  ///< the first `count_` are in use
  std::vector<double> summed_;  ///< (3, T): responses to forces that go together
  std::vector<int> place_;      ///< of a node among them; -1: not there
  int count_ = 0;
  int turn_ = 0;
  std::int64_t step_ = 0;
};

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
  void clear_cache() noexcept;
  /// State, in or out (StateArchive).
  void archive(StateArchive& state);

 private:
  Columns& columns_;
  ForceHistory history_;
  PredictionCache<Columns> stepped_;
  PredictionCache<Columns> horizon_cache_;
};

}  // namespace irdm
