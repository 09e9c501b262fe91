#pragma once

#include <optional>
#include <vector>

#include "common/geometry.hpp"

namespace irdm::replay {

/// How much later a hand is touched in B than in A.
struct OnsetDelays {
  std::vector<double> onsets;  ///< in A, of those that B has, too [s]
  std::vector<double> delays;  ///< of each: when in B, less when in A [s]
  std::size_t alone = 0;       ///< onsets of A and B that the other has not
  double largest = 0.0;        ///< of the delays' sizes [s]

  /// Whether the largest delay is. Nothing where frames are further apart [s] than what is noticed,
  /// or there is no onset in both runs.
  std::optional<bool> noticeable(double interval) const;
};

/// When a force sets in [s]: frames that have one after at least 50 ms without, or at the start.
/// `force` has a row for each time.
std::vector<double> onsets_of(const Points& force, const std::vector<double>& times);

/// Onsets belong together that are the nearest to each other, both ways, and within 0.25 s.
OnsetDelays onset_delays(const std::vector<double>& a, const std::vector<double>& b);

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
