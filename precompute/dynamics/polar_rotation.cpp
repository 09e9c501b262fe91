#include "precompute/dynamics/polar_rotation.hpp"

#include <cmath>

namespace irdm::precompute {
namespace {

Matrix3 by_singular_values(const Matrix3& F) {
  const Eigen::JacobiSVD<Matrix3> svd(F, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Matrix3 u = svd.matrixU();
  if ((u * svd.matrixV().transpose()).determinant() < 0.0) u.col(2) = -u.col(2);
  return u * svd.matrixV().transpose();
}

Matrix3 cofactors(const Matrix3& a) {
  Matrix3 c;
  c.row(0) = a.row(1).cross(a.row(2));
  c.row(1) = a.row(2).cross(a.row(0));
  c.row(2) = a.row(0).cross(a.row(1));
  return c;
}

}  // namespace

Matrix3 polar_rotation(const Matrix3& F) {
  constexpr int kMaxIterations = 30;
  // A step this small leaves an error of its square.
  constexpr double kLastStep = 1e-9;
  const double size = F.norm();
  if (!(F.determinant() > 1e-9 * size * size * size)) return by_singular_values(F);
  Matrix3 q = F;
  for (int i = 0; i < kMaxIterations; ++i) {
    Matrix3 inverse_transposed = cofactors(q);
    inverse_transposed /= q.row(0).dot(inverse_transposed.row(0));
    double scale = std::sqrt(inverse_transposed.norm() / q.norm());
    if (std::abs(scale - 1.0) < 1e-2) scale = 1.0;
    const Matrix3 next = 0.5 * (scale * q + inverse_transposed / scale);
    const double step = (next - q).squaredNorm();
    q = next;
    if (step < kLastStep * kLastStep) return q;
  }
  return by_singular_values(F);
}

}  // namespace irdm::precompute
