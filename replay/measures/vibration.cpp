#include "replay/measures/vibration.hpp"

namespace irdm::replay {

Vibration vibration_of(const Points& force, double dt, const perception::Hand& hand) {
  constexpr double kSegment = 0.5;
  Vibration found;
  found.spectrum = amplitude_spectrum(force, dt, kSegment, Hold::kLargest);
  for (std::size_t i = 0; i < found.spectrum.frequency.size(); ++i) {
    const double frequency = found.spectrum.frequency[i];
    double& amplitude = found.spectrum.amplitude[i];
    amplitude *= perception::hand_compliance(hand, frequency);
    if (frequency < perception::kLowestVibration) continue;
    const double level = amplitude / perception::vibration_threshold(frequency);
    if (level <= found.level) continue;
    found.level = level;
    found.frequency = frequency;
  }
  return found;
}

std::optional<bool> Vibration::noticeable() const {
  const bool judged =
      !spectrum.frequency.empty() && spectrum.frequency.back() >= perception::kLowestVibration;
  if (!judged) return {};
  return level > 1.0;
}

}  // namespace irdm::replay
