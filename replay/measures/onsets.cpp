#include "replay/measures/onsets.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "replay/measures/perception.hpp"

namespace irdm::replay {
namespace {

constexpr double kQuiet = 0.05;
constexpr double kTogether = 0.25;

std::size_t nearest_to(double time, const std::vector<double>& onsets) {
  const auto best = std::min_element(onsets.begin(), onsets.end(), [&](double left, double right) {
    return std::abs(left - time) < std::abs(right - time);
  });
  return static_cast<std::size_t>(best - onsets.begin());
}

}  // namespace

std::optional<bool> OnsetDelays::noticeable(double interval) const {
  if (onsets.empty() || interval > perception::kOnsetDelay) return {};
  return largest > perception::kOnsetDelay;
}

std::vector<double> onsets_of(const Points& force, const std::vector<double>& times) {
  std::vector<double> onsets;
  double last = -std::numeric_limits<double>::infinity();  // time of the last force
  for (std::size_t k = 0; k < times.size(); ++k) {
    if (force.row(static_cast<Eigen::Index>(k)).isZero(0.0)) continue;
    if (times[k] - last > kQuiet) onsets.push_back(times[k]);
    last = times[k];
  }
  return onsets;
}

OnsetDelays onset_delays(const std::vector<double>& a, const std::vector<double>& b) {
  OnsetDelays found;
  for (std::size_t i = 0; i < a.size() && !b.empty(); ++i) {
    const std::size_t j = nearest_to(a[i], b);
    if (nearest_to(b[j], a) != i || std::abs(b[j] - a[i]) > kTogether) continue;
    found.onsets.push_back(a[i]);
    found.delays.push_back(b[j] - a[i]);
    found.largest = std::max(found.largest, std::abs(b[j] - a[i]));
  }
  found.alone = a.size() + b.size() - 2 * found.onsets.size();
  return found;
}

}  // namespace irdm::replay
