#include "replay/compare/time_interval.hpp"

#include <cmath>

namespace irdm::replay {

TimeInterval longest_stretch(const std::vector<bool>& marked) {
  TimeInterval longest;
  TimeInterval now;
  for (std::size_t k = 0; k < marked.size(); ++k) {
    now = marked[k] ? TimeInterval{now.count > 0 ? now.first : k, now.count + 1} : TimeInterval{};
    if (now.count > longest.count) longest = now;
  }
  return longest;
}

bool evenly_spaced(const std::vector<double>& times) {
  constexpr double kWithin = 0.01;
  if (times.size() < 2) return false;
  const double mean = (times.back() - times.front()) / static_cast<double>(times.size() - 1);
  for (std::size_t k = 1; k < times.size(); ++k) {
    if (std::abs(times[k] - times[k - 1] - mean) > kWithin * mean) return false;
  }
  return true;
}

}  // namespace irdm::replay
