#pragma once

#include <Eigen/Dense>

#include "common/geometry.hpp"

namespace irdm {

/// Products of the components of an angular velocity, in the order of the centrifugal data in a
/// model file: xx, yy, zz, yz, xz, xy.
inline constexpr int kSpinProducts = 6;
using SpinProducts = Eigen::Matrix<double, kSpinProducts, 1>;

/// @param w angular velocity [rad/s], B
inline SpinProducts spin_products(const Vector3& w) noexcept {
  SpinProducts q;
  q << w.x() * w.x(), w.y() * w.y(), w.z() * w.z(), w.y() * w.z(), w.x() * w.z(), w.x() * w.y();
  return q;
}

}  // namespace irdm
