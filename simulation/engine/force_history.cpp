#include "simulation/engine/force_history.hpp"

#include <algorithm>
#include <cmath>

#include "simulation/engine/kernels.hpp"
#include "simulation/state/state_archive.hpp"

namespace irdm {

ForceHistory::ForceHistory(int nodes, int steps)
    : steps_(steps),
      values_(static_cast<std::size_t>(nodes) * 3 * 2 * static_cast<std::size_t>(steps), 0.0),
      first_(static_cast<std::size_t>(nodes), -1),
      last_(static_cast<std::size_t>(nodes), -1) {
  active_.reserve(static_cast<std::size_t>(nodes));
}

void ForceHistory::push(std::span<const NodalForce> forces) noexcept {
  ++clock_;
  head_ = head_ == 0 ? steps_ - 1 : head_ - 1;
  // Nodes whose last force has left the window are forgotten; the others have no force yet.
  std::erase_if(active_, [&](int node) {
    const auto index = static_cast<std::size_t>(node);
    if (clock_ - last_[index] < steps_) return false;
    first_[index] = -1;
    return true;
  });
  for (const int node : active_) {
    for (int axis = 0; axis < 3; ++axis) {
      slot(node, axis)[head_] = slot(node, axis)[head_ + steps_] = 0.0;
    }
  }
  for (const NodalForce& nodal : forces) {
    const auto index = static_cast<std::size_t>(nodal.node);
    if (first_[index] < 0) {
      first_[index] = clock_;
      active_.push_back(nodal.node);
      for (int axis = 0; axis < 3; ++axis) slot(nodal.node, axis)[head_] = 0.0;
    }
    last_[index] = clock_;
    for (int axis = 0; axis < 3; ++axis) {
      double* values = slot(nodal.node, axis);
      values[head_] += nodal.force[axis];
      values[head_ + steps_] = values[head_];
    }
  }
}

bool ForceHistory::add_delayed_force(std::span<const NodalForce> forces, int age) noexcept {
  if (age < 0 || age >= steps_ || age > clock_) return false;
  const std::int64_t then = clock_ - age;
  for (const NodalForce& nodal : forces) {
    const auto index = static_cast<std::size_t>(nodal.node);
    const bool active = first_[index] >= 0;
    // What was not followed until now is zero from then on.
    const auto known =
        active ? static_cast<int>(std::min<std::int64_t>(clock_ - first_[index], steps_ - 1)) : -1;
    for (int axis = 0; axis < 3; ++axis) {
      double* values = slot(nodal.node, axis);
      for (int i = known + 1; i <= age; ++i) {
        const int at = (head_ + i) % steps_;
        values[at] = values[at + steps_] = 0.0;
      }
      const int at = (head_ + age) % steps_;
      values[at] += nodal.force[axis];
      values[at + steps_] = values[at];
    }
    if (!active) active_.push_back(nodal.node);
    first_[index] = active ? std::min(first_[index], then) : then;
    last_[index] = active ? std::max(last_[index], then) : then;
  }
  return true;
}

void ForceHistory::clear() noexcept {
  for (const int node : active_) first_[static_cast<std::size_t>(node)] = -1;
  active_.clear();
}

// Of each active node the forces of all ages since it became so, the newest first.
void ForceHistory::archive(StateArchive& state) {
  state.same(static_cast<std::uint64_t>(steps_));
  if (state.reading()) {
    clear();
    head_ = 0;
  }
  state.value(clock_);
  state.list(active_);
  for (const int node : active_) {
    const auto index = static_cast<std::size_t>(node);
    state.value(first_[index]);
    state.value(last_[index]);
    const auto count =
        static_cast<std::size_t>(std::min<std::int64_t>(clock_ - first_[index] + 1, steps_));
    for (int axis = 0; axis < 3; ++axis) {
      double* const forces = slot(node, axis);
      state.numbers(forces + head_, count);
      if (state.reading()) std::copy_n(forces, count, forces + steps_);
    }
  }
}

ForceHistory::Series ForceHistory::series(int node, int axis) const noexcept {
  const auto index = static_cast<std::size_t>(node);
  const auto youngest = static_cast<int>(clock_ - last_[index]);
  const auto oldest = static_cast<int>(std::min<std::int64_t>(clock_ - first_[index], steps_ - 1));
  const double* values = values_.data() + (3 * index + static_cast<std::size_t>(axis)) * 2 *
                                              static_cast<std::size_t>(steps_);
  return {values + head_ + youngest, youngest, oldest - youngest + 1};
}

double ForceHistory::multiple(int node, int of) const noexcept {
  int largest = 0;
  for (int axis = 1; axis < 3; ++axis) {
    if (std::abs(series(of, axis).force[0]) > std::abs(series(of, largest).force[0])) {
      largest = axis;
    }
  }
  const double newest = series(of, largest).force[0];
  if (newest == 0.0) return 0.0;
  const double factor = series(node, largest).force[0] / newest;
  for (int axis = 0; axis < 3; ++axis) {
    const Series a = series(node, axis);
    const Series b = series(of, axis);
    if (a.first_age != b.first_age || a.count != b.count) return 0.0;
    if (!is_multiple(a.force, factor, b.force, static_cast<std::size_t>(a.count))) return 0.0;
  }
  return factor;
}

namespace {

void append(const ForceHistory::Series& series, std::size_t column,
            std::vector<NonzeroInterval>& intervals) {
  const auto count = static_cast<std::size_t>(series.count);
  bool any = false;
  std::size_t begin = 0;
  std::size_t end = 0;  // after the last force so far
  const auto finish = [&] {
    if (!any) return;
    intervals.push_back({column, static_cast<std::size_t>(series.first_age) + begin, end - begin,
                         series.force + begin});
  };
  for (std::size_t i = 0; i < count; ++i) {
    if (series.force[i] == 0.0) continue;
    if (!any || i - end >= kSilence) {
      finish();
      begin = i;
    }
    any = true;
    end = i + 1;
  }
  finish();
}

}  // namespace

std::vector<NonzeroInterval> nonzero_intervals(const ForceHistory& history) {
  std::vector<NonzeroInterval> intervals;
  for (const int node : history.active()) {
    for (int axis = 0; axis < 3; ++axis) {
      append(history.series(node, axis), static_cast<std::size_t>(3 * node + axis), intervals);
    }
  }
  return intervals;
}

}  // namespace irdm
