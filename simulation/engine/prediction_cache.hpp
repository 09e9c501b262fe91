#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/contact/contact_model.hpp"
#include "simulation/engine/force_history.hpp"
#include "simulation/engine/kernels.hpp"
#include "simulation/engine/resident_columns.hpp"

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

}  // namespace irdm
