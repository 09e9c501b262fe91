#pragma once

#include <optional>
#include <vector>

#include "common/geometry.hpp"

namespace irdm::replay {

/// How much an object gives under a stylus, found from frames in contact: the line through zero
/// that fits the displacement along the force best.
class Compliance {
 public:
  /// One frame: displacement along the force [m], size of the force [N]. Forces below 0.05 N are
  /// left out.
  void add(double along, double force) noexcept;

  bool known() const noexcept { return force_ > 0.0; }
  double value() const noexcept { return known() ? product_ / force_ : 0.0; }  ///< [m/N]

 private:
  double product_ = 0.0;  ///< sum of displacement times force [N m]
  double force_ = 0.0;    ///< sum of force squared [N^2]
};

/// The largest displacement of a node along a direction (of any length but 0); u (n, 3).
double largest_along(const Points& u, const Vector3& direction);

/// Whether a hand that felt one force would notice that it is the other.
struct ForceDifference {
  std::vector<double> share;     ///< of each frame: of the force of A, 0 where neither acts
  double largest = 0.0;          ///< of them
  std::size_t worst_frame = 0;   ///< where that is
  double noticeable_time = 0.0;  ///< share of the frames in contact that are above the limit
  bool contact = false;          ///< a force acts in some frame, in A or B
  /// Nothing where there was no contact.
  std::optional<bool> noticeable() const noexcept {
    return contact ? std::optional(noticeable_time > 0.0) : std::nullopt;
  }
};

/// Forces on a stylus, a row every dt [s] [N], both averaged over perception::kForceTime round each
/// frame; judged in the frames in which one of them acts. The share is |F_B - F_A| over |F_A|, or
/// over perception::kSmallForce if that is more; the limit perception::kForceShare.
ForceDifference force_difference(const Points& a, const Points& b, double dt);

/// Means over the rows within `time` / 2 before and after each row, fewer at the ends.
Points smoothed(const Points& signal, double dt, double time);

}  // namespace irdm::replay
