#include "server/engine/followed_nodes.hpp"

#include <algorithm>

#include "server/engine/held_columns.hpp"

namespace irdm {

template <typename Columns>
FollowedNodes<Columns>::FollowedNodes(const Columns& columns) : columns_(columns) {
  if (columns.frame().dof == 0) return;
  followed_.resize(kMost);
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
  const std::array<double*, 3> to{followed.coming[0].data() + end, followed.coming[1].data() + end,
                                  followed.coming[2].data() + end};
  const std::size_t steps = columns_.frame().steps;
  for (const int source : history.active()) {
    for (int b = 3 * source; b < 3 * source + 3 && columns_.whole(source); ++b) {
      const ForceHistory::Series series = history.series(source, b % 3);
      const auto first = static_cast<std::size_t>(series.first_age + followed.length + 1);
      if (first >= steps) continue;
      add_ahead(NodeRows<Number>{columns_.row(3 * followed.node, b) + first, steps, steps - first},
                {series.force, static_cast<std::size_t>(series.count)},
                columns_.frame().scale(static_cast<std::size_t>(b)), to);
    }
  }
  followed.length += followed.begun ? kMore : 1 + turn_++ % kMore;
  followed.begun = true;
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
  const int known = static_cast<int>(frame.steps) - 1 - age;
  for (int i = 0; i < count_; ++i) {
    Followed& followed = followed_[static_cast<std::size_t>(i)];
    const int count = std::min(followed.length, known);
    if (count <= 0) continue;
    for (const NodalForce& nodal : forces) {
      if (!columns_.whole(nodal.node)) continue;
      std::array<double, 3> weights{};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto b = 3 * static_cast<std::size_t>(nodal.node) + axis;
        weights[axis] = frame.scale(b) * nodal.force[static_cast<Eigen::Index>(axis)];
      }
      const Number* first = columns_.row(3 * followed.node, 3 * nodal.node) + age + 1;
      for (std::size_t row = 0; row < 3; ++row) {
        const Number* at = first + row * frame.steps;
        const std::size_t column = frame.dof * frame.steps;
        accumulate(weights, at, at + column, at + 2 * column,
                   followed.coming[row].data() + followed.begin, static_cast<std::size_t>(count));
      }
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
