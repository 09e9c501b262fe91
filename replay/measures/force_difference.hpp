#pragma once

#include <vector>

#include "common/geometry.hpp"

namespace irdm::replay {

/// Whether a hand that felt one force would notice that it is the other.
struct ForceDifference {
  std::vector<double> share;     ///< of each frame: of the force of A, 0 where neither acts
  double largest = 0.0;          ///< of them
  std::size_t worst_frame = 0;   ///< where that is
  double noticeable_time = 0.0;  ///< share of the frames in contact that are above the limit
  bool noticeable() const noexcept { return noticeable_time > 0.0; }
};

/// Forces on a stylus, a row every dt [s] [N], both averaged over perception::kForceTime round each
/// frame. The share is |F_B - F_A| over |F_A|, or over perception::kSmallForce if that is more; the
/// limit perception::kForceShare.
ForceDifference force_difference(const Points& a, const Points& b, double dt);

/// Means over the rows within `time` / 2 before and after each row, fewer at the ends.
Points smoothed(const Points& signal, double dt, double time);

}  // namespace irdm::replay
