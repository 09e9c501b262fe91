#pragma once

#include <optional>
#include <vector>

#include "common/geometry.hpp"
#include "replay/measures/perception.hpp"

namespace irdm::replay {

/// What of a signal is in each frequency, as the amplitude of a sine wave that would give as much.
struct Spectrum {
  std::vector<double> frequency;  ///< [Hz], from one step above 0 to half the rate of the samples
  std::vector<double> amplitude;  ///< in the signal's unit; of vectors the length over components
};

/// Of several segments: the root of the mean square, or the largest.
enum class Hold { kMean, kLargest };

/// Spectrum of a signal with a row every dt [s], from segments of `segment` [s] (or the whole
/// signal if it is shorter), each less its mean and under a Hann window, which overlap by half.
/// A sine wave whose period divides the segment has its amplitude at its frequency. Empty for
/// fewer than 8 rows.
Spectrum amplitude_spectrum(const Points& signal, double dt, double segment, Hold hold);

/// A force as the vibration that it makes of a hand.
struct Vibration {
  Spectrum spectrum;       ///< motion of the hand [m]: the largest in any half second
  double level = 0.0;      ///< amplitude over threshold, where that is most; 0: none is known
  double frequency = 0.0;  ///< where that is [Hz]

  /// Nothing where the rows are too few a second for such frequencies.
  std::optional<bool> noticeable() const;
};

/// Of a force with a row every dt [s] [N]. Looks at perception::kLowestVibration and above, and up
/// to half the rate of the rows.
Vibration vibration_of(const Points& force, double dt, const perception::Hand& hand);

}  // namespace irdm::replay
