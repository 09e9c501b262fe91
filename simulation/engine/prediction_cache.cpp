#include "simulation/engine/prediction_cache.hpp"

#include <algorithm>

#include "simulation/engine/pinned_columns.hpp"
#include "simulation/state/state_archive.hpp"

namespace irdm {

template <typename Columns>
CachedConvolution<Columns>::CachedConvolution(Columns& columns, int sources)
    : columns_(columns),
      history_(sources, static_cast<int>(columns.frame().steps)),
      stepped_(columns),
      horizon_cache_(columns) {}

// As the step to come is asked for once this one has ended, the one after next is the coming one.
template <typename Columns>
void CachedConvolution<Columns>::cache_node(int node) noexcept {
  stepped_.cache_node(history_, node, 2);
}

template <typename Columns>
void CachedConvolution<Columns>::add_coming(int node, Vector3& u) const noexcept {
  if (!stepped_.add_coming(node, 1, u)) columns_.convolve(history_, node, 1, u);
}

template <typename Columns>
void CachedConvolution<Columns>::predict_horizon(int node, int n) noexcept {
  horizon_cache_.cache_node(history_, node, n);
}

template <typename Columns>
void CachedConvolution<Columns>::add_ahead(int node, int n, Vector3& u) const noexcept {
  if (!horizon_cache_.add_coming(node, n, u)) columns_.convolve(history_, node, n, u);
}

template <typename Columns>
void CachedConvolution<Columns>::push(std::span<const NodalForce> forces) noexcept {
  history_.push(forces);
  if (columns_.update(history_)) clear_cache();
  stepped_.push(forces);
  horizon_cache_.push(forces);
}

template <typename Columns>
void CachedConvolution<Columns>::add_delayed_force(std::span<const NodalForce> forces,
                                                   int age) noexcept {
  if (!history_.add_delayed_force(forces, age)) return;
  if (columns_.update(history_)) clear_cache();
  stepped_.add_delayed_force(forces, age);
  horizon_cache_.add_delayed_force(forces, age);
}

template <typename Columns>
void CachedConvolution<Columns>::clear() noexcept {
  history_.clear();
  clear_cache();
}

template <typename Columns>
void CachedConvolution<Columns>::clear_cache() noexcept {
  stepped_.clear();
  horizon_cache_.clear();
}

template <typename Columns>
void CachedConvolution<Columns>::archive(StateArchive& state) {
  history_.archive(state);
  stepped_.archive(state);
  if (state.reading()) horizon_cache_.clear();
}

template class CachedConvolution<ResidentColumns<float>>;
template class CachedConvolution<ResidentColumns<double>>;
template class CachedConvolution<PinnedColumns<float>>;
template class CachedConvolution<PinnedColumns<double>>;

template <typename Columns>
PredictionCache<Columns>::PredictionCache(const Columns& columns) : columns_(columns) {
  if (columns.frame().dof == 0) return;
  cached_.resize(kMost);
  summed_.resize(3 * columns.frame().steps);
  place_.assign(columns.frame().dof / 3, -1);
}

template <typename Columns>
void PredictionCache<Columns>::cache_node(const ForceHistory& history, int node, int n) noexcept {
  if (history.active().empty()) return;
  Cached* cached = find(node);
  if (cached == nullptr || cached->first == step_) return;
  while (cached->length < n) extend(history, *cached);
}

// Null where there is no room.
template <typename Columns>
auto PredictionCache<Columns>::find(int node) noexcept -> Cached* {
  if (place_.empty()) return nullptr;
  int& place = place_[static_cast<std::size_t>(node)];
  if (place < 0 && count_ == kMost) return nullptr;
  const bool is_new = place < 0;
  if (is_new) place = count_++;
  Cached& cached = cached_[static_cast<std::size_t>(place)];
  cached.last = step_;
  if (!is_new) return &cached;
  cached.node = node;
  cached.length = 0;
  cached.begun = false;
  cached.first = step_;
  return &cached;
}

template <typename Columns>
bool PredictionCache<Columns>::add_coming(int node, int n, Vector3& u) const noexcept {
  if (place_.empty()) return false;
  const int place = place_[static_cast<std::size_t>(node)];
  if (place < 0) return false;
  const Cached& cached = cached_[static_cast<std::size_t>(place)];
  if (n > cached.length) return false;
  const auto at = static_cast<std::size_t>(cached.begin + n - 1);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    u[static_cast<Eigen::Index>(axis)] += cached.coming[axis][at];
  }
  return true;
}

// A first time falls short, each by another number of steps, so that the next times spread.
template <typename Columns>
void PredictionCache<Columns>::extend(const ForceHistory& history, Cached& cached) noexcept {
  constexpr auto kMore = static_cast<int>(kStepsAhead);
  if (cached.length == 0 || cached.begin + cached.length + kMore > kRoom) {
    for (auto& coming : cached.coming) {
      std::copy_n(coming.begin() + cached.begin, cached.length, coming.begin());
    }
    cached.begin = 0;
  }
  const int end = cached.begin + cached.length;
  for (auto& coming : cached.coming) std::fill_n(coming.begin() + end, kMore, 0.0);
  for (std::span<const int> left = history.active(); !left.empty();) {
    const Together sources = together(history, left);
    left = left.subspan(sources.count);
    if (columns_.whole(sources.nodes[0])) add_ahead_of(history, sources, cached);
  }
  cached.length += cached.begun ? kMore : 1 + turn_++ % kMore;
  cached.begun = true;
}

// Of the nodes that were pushed together those that follow the first: a patch that sticks.
template <typename Columns>
auto PredictionCache<Columns>::together(const ForceHistory& history,
                                        std::span<const int> sources) const noexcept -> Together {
  Together found;
  for (const int node : sources.first(std::min(sources.size(), kMostTogether))) {
    const bool is_first = found.count == 0;
    const double factor = is_first ? 1.0 : history.multiple(node, found.nodes[0]);
    if (factor == 0.0 || columns_.whole(node) != columns_.whole(sources[0])) break;
    found.nodes[found.count] = node;
    found.factors[found.count++] = factor;
  }
  return found;
}

template <typename Columns>
void PredictionCache<Columns>::add_ahead_of(const ForceHistory& history, const Together& sources,
                                            Cached& cached) noexcept {
  const ResidentColumns<Number>& frame = columns_.frame();
  const int end = cached.begin + cached.length;
  const std::array<double*, 3> to{cached.coming[0].data() + end, cached.coming[1].data() + end,
                                  cached.coming[2].data() + end};
  for (int axis = 0; axis < 3; ++axis) {
    const ForceHistory::Series series = history.series(sources.nodes[0], axis);
    const auto first = static_cast<std::size_t>(series.first_age + cached.length + 1);
    if (first >= frame.steps) continue;
    const std::size_t known = frame.steps - first;
    const std::span forces(series.force, static_cast<std::size_t>(series.count));
    const auto row = [&](std::size_t source) {
      return columns_.row(3 * cached.node, 3 * sources.nodes[source] + axis) + first;
    };
    const auto& weights = sources.factors;
    if (sources.count == 1) {
      add_ahead(NodeRows<Number>{row(0), frame.steps, known}, forces, weights[0], to);
      continue;
    }
    const std::size_t count = std::min(known, forces.size() + kStepsAhead - 1);
    std::fill(summed_.begin(), summed_.end(), 0.0);
    for (std::size_t s = 0; s < sources.count; s += 3) {
      const std::size_t t = std::min(s + 1, sources.count - 1);
      const std::size_t u = std::min(s + 2, sources.count - 1);
      const std::array three{weights[s], t > s ? weights[t] : 0.0, u > t ? weights[u] : 0.0};
      for (std::size_t r = 0; r < 3; ++r) {
        const std::size_t at = r * frame.steps;
        accumulate(three, row(s) + at, row(t) + at, row(u) + at, summed_.data() + at, count);
      }
    }
    add_ahead(NodeRows<double>{summed_.data(), frame.steps, count}, forces, 1.0, to);
  }
}

template <typename Columns>
void PredictionCache<Columns>::push(std::span<const NodalForce> forces) noexcept {
  ++step_;
  forget_idle();
  for (int i = 0; i < count_; ++i) {
    Cached& cached = cached_[static_cast<std::size_t>(i)];
    if (cached.length == 0) continue;
    ++cached.begin;
    --cached.length;
  }
  add(forces, 0);
}

template <typename Columns>
void PredictionCache<Columns>::add_delayed_force(std::span<const NodalForce> forces,
                                                 int age) noexcept {
  add(forces, age);
}

template <typename Columns>
void PredictionCache<Columns>::add(std::span<const NodalForce> forces, int age) noexcept {
  const ResidentColumns<Number>& frame = columns_.frame();
  const auto first = static_cast<std::size_t>(age) + 1;
  if (first >= frame.steps) return;
  for (const NodalForce& nodal : forces) {
    if (!columns_.whole(nodal.node)) continue;
    const std::array<double, 3> force{nodal.force.x(), nodal.force.y(), nodal.force.z()};
    for (int i = 0; i < count_; ++i) {
      Cached& cached = cached_[static_cast<std::size_t>(i)];
      if (cached.length == 0) continue;
      const std::array<double*, 3> to{cached.coming[0].data() + cached.begin,
                                      cached.coming[1].data() + cached.begin,
                                      cached.coming[2].data() + cached.begin};
      add_effect(NodeColumns<Number>{columns_.row(3 * cached.node, 3 * nodal.node) + first,
                                     frame.steps, frame.dof * frame.steps, frame.steps - first},
                 force, to, static_cast<std::size_t>(cached.length));
    }
  }
}

template <typename Columns>
void PredictionCache<Columns>::forget_idle() noexcept {
  for (int i = 0; i < count_;) {
    Cached& cached = cached_[static_cast<std::size_t>(i)];
    if (step_ - cached.last <= kPatience) {
      ++i;
      continue;
    }
    place_[static_cast<std::size_t>(cached.node)] = -1;
    cached = cached_[static_cast<std::size_t>(--count_)];
    if (i < count_) place_[static_cast<std::size_t>(cached.node)] = i;
  }
}

template <typename Columns>
void PredictionCache<Columns>::clear() noexcept {
  for (int i = 0; i < count_; ++i) {
    place_[static_cast<std::size_t>(cached_[static_cast<std::size_t>(i)].node)] = -1;
  }
  count_ = 0;
  turn_ = 0;
}

template <typename Columns>
void PredictionCache<Columns>::archive(StateArchive& state) {
  if (state.reading()) clear();
  count_ = static_cast<int>(state.size(static_cast<std::size_t>(count_), cached_.size()));
  for (int i = 0; i < count_; ++i) {
    Cached& cached = cached_[static_cast<std::size_t>(i)];
    if (state.reading()) cached.begin = 0;
    state.value(cached.node);
    cached.length = static_cast<int>(state.size(static_cast<std::size_t>(cached.length), kRoom));
    state.value(cached.begun);
    state.value(cached.first);
    state.value(cached.last);
    for (auto& coming : cached.coming) {
      state.numbers(coming.data() + cached.begin, static_cast<std::size_t>(cached.length));
    }
    place_[static_cast<std::size_t>(cached.node)] = i;
  }
  state.value(turn_);
  state.value(step_);
}

template class PredictionCache<ResidentColumns<float>>;
template class PredictionCache<ResidentColumns<double>>;
template class PredictionCache<PinnedColumns<float>>;
template class PredictionCache<PinnedColumns<double>>;

}  // namespace irdm
