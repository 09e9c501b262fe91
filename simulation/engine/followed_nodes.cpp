#include "simulation/engine/followed_nodes.hpp"

#include <algorithm>

#include "simulation/engine/held_columns.hpp"

namespace irdm {

template <typename Columns>
FollowedNodes<Columns>::FollowedNodes(const Columns& columns) : columns_(columns) {
  if (columns.frame().dof == 0) return;
  followed_.resize(kMost);
  summed_.resize(3 * columns.frame().steps);
  place_.assign(columns.frame().dof / 3, -1);
}

template <typename Columns>
void FollowedNodes<Columns>::follow(const ForceHistory& history, int node, int n) noexcept {
  if (history.active().empty()) return;
  Followed* followed = find(node);
  if (followed == nullptr || followed->first == step_) return;
  while (followed->length < n) extend(history, *followed);
}

// Null where there is no room.
template <typename Columns>
auto FollowedNodes<Columns>::find(int node) noexcept -> Followed* {
  if (place_.empty()) return nullptr;
  int& place = place_[static_cast<std::size_t>(node)];
  if (place < 0 && count_ == kMost) return nullptr;
  const bool is_new = place < 0;
  if (is_new) place = count_++;
  Followed& followed = followed_[static_cast<std::size_t>(place)];
  followed.last = step_;
  if (!is_new) return &followed;
  followed.node = node;
  followed.length = 0;
  followed.begun = false;
  followed.first = step_;
  return &followed;
}

template <typename Columns>
bool FollowedNodes<Columns>::add_coming(int node, int n, Vector3& u) const noexcept {
  if (place_.empty()) return false;
  const int place = place_[static_cast<std::size_t>(node)];
  if (place < 0) return false;
  const Followed& followed = followed_[static_cast<std::size_t>(place)];
  if (n > followed.length) return false;
  const auto at = static_cast<std::size_t>(followed.begin + n - 1);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    u[static_cast<Eigen::Index>(axis)] += followed.coming[axis][at];
  }
  return true;
}

// A first time falls short, each by another number of steps, so that the next times spread.
template <typename Columns>
void FollowedNodes<Columns>::extend(const ForceHistory& history, Followed& followed) noexcept {
  constexpr auto kMore = static_cast<int>(kStepsAhead);
  if (followed.length == 0 || followed.begin + followed.length + kMore > kRoom) {
    for (auto& coming : followed.coming) {
      std::copy_n(coming.begin() + followed.begin, followed.length, coming.begin());
    }
    followed.begin = 0;
  }
  const int end = followed.begin + followed.length;
  for (auto& coming : followed.coming) std::fill_n(coming.begin() + end, kMore, 0.0);
  for (std::span<const int> left = history.active(); !left.empty();) {
    const Together sources = together(history, left);
    left = left.subspan(sources.count);
    if (columns_.whole(sources.nodes[0])) add_ahead_of(history, sources, followed);
  }
  followed.length += followed.begun ? kMore : 1 + turn_++ % kMore;
  followed.begun = true;
}

// Of the nodes that were pushed together those that follow the first: a patch that sticks.
template <typename Columns>
auto FollowedNodes<Columns>::together(const ForceHistory& history,
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
void FollowedNodes<Columns>::add_ahead_of(const ForceHistory& history, const Together& sources,
                                          Followed& followed) noexcept {
  const ResidentColumns<Number>& frame = columns_.frame();
  const int end = followed.begin + followed.length;
  const std::array<double*, 3> to{followed.coming[0].data() + end, followed.coming[1].data() + end,
                                  followed.coming[2].data() + end};
  for (int axis = 0; axis < 3; ++axis) {
    const ForceHistory::Series series = history.series(sources.nodes[0], axis);
    const auto first = static_cast<std::size_t>(series.first_age + followed.length + 1);
    if (first >= frame.steps) continue;
    const std::size_t known = frame.steps - first;
    const std::span forces(series.force, static_cast<std::size_t>(series.count));
    const auto row = [&](std::size_t source) {
      return columns_.row(3 * followed.node, 3 * sources.nodes[source] + axis) + first;
    };
    const auto weight = [&](std::size_t source) {
      const int b = 3 * sources.nodes[source] + axis;
      return sources.factors[source] * frame.scale(static_cast<std::size_t>(b));
    };
    if (sources.count == 1) {
      add_ahead(NodeRows<Number>{row(0), frame.steps, known}, forces, weight(0), to);
      continue;
    }
    const std::size_t count = std::min(known, forces.size() + kStepsAhead - 1);
    std::fill(summed_.begin(), summed_.end(), 0.0);
    for (std::size_t s = 0; s < sources.count; s += 3) {
      const std::size_t t = std::min(s + 1, sources.count - 1);
      const std::size_t u = std::min(s + 2, sources.count - 1);
      const std::array weights{weight(s), t > s ? weight(t) : 0.0, u > t ? weight(u) : 0.0};
      for (std::size_t r = 0; r < 3; ++r) {
        const std::size_t at = r * frame.steps;
        accumulate(weights, row(s) + at, row(t) + at, row(u) + at, summed_.data() + at, count);
      }
    }
    add_ahead(NodeRows<double>{summed_.data(), frame.steps, count}, forces, 1.0, to);
  }
}

template <typename Columns>
void FollowedNodes<Columns>::push(std::span<const NodalForce> forces) noexcept {
  ++step_;
  forget_idle();
  for (int i = 0; i < count_; ++i) {
    Followed& followed = followed_[static_cast<std::size_t>(i)];
    if (followed.length == 0) continue;
    ++followed.begin;
    --followed.length;
  }
  add(forces, 0);
}

template <typename Columns>
void FollowedNodes<Columns>::add_past(std::span<const NodalForce> forces, int age) noexcept {
  add(forces, age);
}

template <typename Columns>
void FollowedNodes<Columns>::add(std::span<const NodalForce> forces, int age) noexcept {
  const ResidentColumns<Number>& frame = columns_.frame();
  const auto first = static_cast<std::size_t>(age) + 1;
  if (first >= frame.steps) return;
  for (const NodalForce& nodal : forces) {
    if (!columns_.whole(nodal.node)) continue;
    std::array<double, 3> weights{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto b = 3 * static_cast<std::size_t>(nodal.node) + axis;
      weights[axis] = frame.scale(b) * nodal.force[static_cast<Eigen::Index>(axis)];
    }
    for (int i = 0; i < count_; ++i) {
      Followed& followed = followed_[static_cast<std::size_t>(i)];
      if (followed.length == 0) continue;
      const std::array<double*, 3> to{followed.coming[0].data() + followed.begin,
                                      followed.coming[1].data() + followed.begin,
                                      followed.coming[2].data() + followed.begin};
      add_effect(NodeColumns<Number>{columns_.row(3 * followed.node, 3 * nodal.node) + first,
                                     frame.steps, frame.dof * frame.steps, frame.steps - first},
                 weights, to, static_cast<std::size_t>(followed.length));
    }
  }
}

template <typename Columns>
void FollowedNodes<Columns>::forget_idle() noexcept {
  for (int i = 0; i < count_;) {
    Followed& followed = followed_[static_cast<std::size_t>(i)];
    if (step_ - followed.last <= kPatience) {
      ++i;
      continue;
    }
    place_[static_cast<std::size_t>(followed.node)] = -1;
    followed = followed_[static_cast<std::size_t>(--count_)];
    if (i < count_) place_[static_cast<std::size_t>(followed.node)] = i;
  }
}

template <typename Columns>
void FollowedNodes<Columns>::clear() noexcept {
  for (int i = 0; i < count_; ++i) {
    place_[static_cast<std::size_t>(followed_[static_cast<std::size_t>(i)].node)] = -1;
  }
  count_ = 0;
  turn_ = 0;
}

template class FollowedNodes<ResidentColumns<Half>>;
template class FollowedNodes<ResidentColumns<float>>;
template class FollowedNodes<ResidentColumns<double>>;
template class FollowedNodes<HeldColumns<Half>>;
template class FollowedNodes<HeldColumns<float>>;
template class FollowedNodes<HeldColumns<double>>;

}  // namespace irdm
