#pragma once

#include <vector>

#include "common/geometry.hpp"

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

}  // namespace irdm::replay
