#pragma once

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

}  // namespace irdm::replay
