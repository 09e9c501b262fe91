#include "simulation/engine/nonzero_intervals.hpp"

namespace irdm {
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
