#pragma once

#include <vector>

#include "common/geometry.hpp"

namespace irdm::replay {

/// One damped oscillation of a signal.
struct Ringing {
  double frequency = 0.0;      ///< at which it oscillates [Hz], so the damped one
  double damping_ratio = 0.0;  ///< zeta: decay rate over undamped angular frequency
  double amplitude = 0.0;      ///< at the signal's first row, in its unit; length over components
};

/// The damped oscillations that a signal with a row every dt [s] is the sum of, by increasing
/// frequency: at most 8, with at least a twentieth of the largest one's amplitude, at least two
/// periods in the signal and a damping ratio from 0 to 0.7. Looks at the first 512 rows. Found by
/// shift invariance of the signal's subspace (ESPRIT: Roy and Kailath 1989, IEEE Trans. ASSP 37(7):
/// 984-995), which is exact for a sum of few damped oscillations and says no more than that there
/// is such a sum for anything else. Empty for fewer than 24 rows.
std::vector<Ringing> find_ringing(const Points& signal, double dt);

/// An oscillation of each of two signals.
struct RingingPair {
  Ringing a, b;
};

/// Which of two lists belong together: each other's nearest in frequency, within 15 %.
std::vector<RingingPair> pairs_of(const std::vector<Ringing>& a, const std::vector<Ringing>& b);

}  // namespace irdm::replay
