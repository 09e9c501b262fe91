#pragma once

#include <optional>

#include "replay/measures/perception.hpp"
#include "replay/measures/spectrum.hpp"

namespace irdm::replay {

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
