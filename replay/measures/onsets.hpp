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

}  // namespace irdm::replay
