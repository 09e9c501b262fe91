#include "replay/measures/perception.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace irdm::replay::perception {

double vibration_threshold(double frequency) noexcept {
  constexpr double kBest = 250.0;
  constexpr double kLeast = 0.1e-6;
  const double within = std::clamp(frequency, kLowestVibration, kBest);
  return kLeast * std::pow(kBest / within, 12.0 / (20.0 * std::numbers::ln2 / std::numbers::ln10));
}

double hand_compliance(const Hand& hand, double frequency) noexcept {
  const double w = 2.0 * std::numbers::pi * frequency;
  return 1.0 / std::hypot(hand.stiffness - hand.mass * w * w, hand.damping * w);
}

}  // namespace irdm::replay::perception
