#include "server/engine/running_convolution.hpp"

#include <algorithm>

namespace irdm {
template <typename Number>
RunningConvolution<Number>::RunningConvolution(const ResidentColumns<Number>& columns, int sources)
    : columns_(columns), history_(sources, static_cast<int>(columns.steps)) {
  if (columns.values == nullptr) return;
  followed_.resize(kMostFollowed);
  place_.assign(columns.dof / 3, -1);
}

template <typename Number>
void RunningConvolution<Number>::add_coming(int node, int n, Vector3& u) noexcept {
  if (history_.active().empty()) return;
  Followed* followed = follow(node);
  if (followed == nullptr) return columns_.convolve(history_, node, n, u);
  while (followed->length < n) extend(*followed);
  const auto at = static_cast<std::size_t>(followed->begin + n - 1);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    u[static_cast<Eigen::Index>(axis)] += followed->coming[axis][at];
  }
}

// Null for a node that was not asked for lately.
template <typename Number>
auto RunningConvolution<Number>::follow(int node) noexcept -> Followed* {
  int& place = place_[static_cast<std::size_t>(node)];
  if (place >= 0) {
    Followed& followed = followed_[static_cast<std::size_t>(place)];
    followed.asked = step_;
    return &followed;
  }
  if (count_ == kMostFollowed) return nullptr;
  place = count_++;
  Followed& followed = followed_[static_cast<std::size_t>(place)];
  followed.node = node;
  followed.length = 0;
  followed.begun = false;
  followed.asked = step_;
  return nullptr;
}

// A first time falls short, each by another number of steps, so that the next times spread.
template <typename Number>
void RunningConvolution<Number>::extend(Followed& followed) noexcept {
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
  const std::span<const int> sources = history_.active();
  const auto rows_of = [&](std::size_t i) {
    return columns_.row(3 * followed.node, 3 * sources[i / 3] + static_cast<int>(i % 3));
  };
  for (std::size_t i = 0; i < 3 * sources.size(); ++i) {
    const ForceHistory::Series series = history_.series(sources[i / 3], static_cast<int>(i % 3));
    const int first = series.first_age + followed.length + 1;
    if (first >= static_cast<int>(columns_.steps)) continue;
    const std::size_t known = columns_.steps - static_cast<std::size_t>(first);
    const std::size_t column = 3 * static_cast<std::size_t>(sources[i / 3]) + i % 3;
    add_ahead(NodeRows<Number>{rows_of(i) + first, columns_.steps, known},
              {series.force, static_cast<std::size_t>(series.count)}, columns_.scale(column), to);
  }
  followed.length += followed.begun ? kMore : 1 + turn_++ % kMore;
  followed.begun = true;
}

template <typename Number>
void RunningConvolution<Number>::push(std::span<const NodalForce> forces) noexcept {
  history_.push(forces);
  ++step_;
  forget_idle();
  for (int i = 0; i < count_; ++i) {
    Followed& followed = followed_[static_cast<std::size_t>(i)];
    if (followed.length == 0) continue;
    ++followed.begin;
    --followed.length;
  }
  add_to_followed(forces, 0);
}

template <typename Number>
void RunningConvolution<Number>::add_past(std::span<const NodalForce> forces, int age) noexcept {
  if (history_.add_past(forces, age)) add_to_followed(forces, age);
}

template <typename Number>
void RunningConvolution<Number>::add_to_followed(std::span<const NodalForce> forces,
                                                 int age) noexcept {
  const int known = static_cast<int>(columns_.steps) - 1 - age;
  for (int i = 0; i < count_; ++i) {
    Followed& followed = followed_[static_cast<std::size_t>(i)];
    const int count = std::min(followed.length, known);
    if (count <= 0) continue;
    for (const NodalForce& nodal : forces) {
      std::array<double, 3> weights{};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto b = 3 * static_cast<std::size_t>(nodal.node) + axis;
        weights[axis] = columns_.scale(b) * nodal.force[static_cast<Eigen::Index>(axis)];
      }
      const Number* first = columns_.row(3 * followed.node, 3 * nodal.node) + age + 1;
      for (std::size_t row = 0; row < 3; ++row) {
        const Number* at = first + row * columns_.steps;
        const std::size_t column = columns_.dof * columns_.steps;
        accumulate(weights, at, at + column, at + 2 * column,
                   followed.coming[row].data() + followed.begin, static_cast<std::size_t>(count));
      }
    }
  }
}

template <typename Number>
void RunningConvolution<Number>::forget_idle() noexcept {
  for (int i = 0; i < count_;) {
    Followed& followed = followed_[static_cast<std::size_t>(i)];
    if (step_ - followed.asked <= kPatience) {
      ++i;
      continue;
    }
    place_[static_cast<std::size_t>(followed.node)] = -1;
    followed = followed_[static_cast<std::size_t>(--count_)];
    if (i < count_) place_[static_cast<std::size_t>(followed.node)] = i;
  }
}

template <typename Number>
void RunningConvolution<Number>::clear() noexcept {
  history_.clear();
  for (int i = 0; i < count_; ++i) {
    place_[static_cast<std::size_t>(followed_[static_cast<std::size_t>(i)].node)] = -1;
  }
  count_ = 0;
  turn_ = 0;
}

template class RunningConvolution<Half>;
template class RunningConvolution<float>;
template class RunningConvolution<double>;

}  // namespace irdm
