#include "precompute/check/inverse_stability.hpp"

#include <algorithm>
#include <cmath>

namespace irdm::precompute {
namespace {

// Where the zeros are looked for, as logarithms of the radius beyond the circle that counts: a mode
// of the force that grows or decays faster a step is not told apart from one at that bound.
constexpr double kInward = 7.0;
constexpr double kNearest = 1e-6;
constexpr double kOutward = 0.5;
constexpr int kPoleBisections = 12;
// Beyond it, a record that was scaled by the powers of the radius overflows when squared and cubed.
constexpr double kLargest = 1e60;

int zeros_inside(const DrivingPoint& record, const Matrix3& rigid, double radius) {
  const bool floating = !rigid.isZero(0.0);
  const MatrixHalfCircle response = transform(record, radius, resolving_half_circle(record.cols()));
  return count_zeros(response, radius,
                     [&](const Eigen::Matrix3cd& r, const std::complex<double>& w) {
                       if (!floating) return r.determinant();
                       const Eigen::Matrix3cd c = (1.0 - w) * (1.0 - w) * r + (1.0 + w) * rigid;
                       return c.determinant();
                     });
}

}  // namespace

InverseStability analyse_inverse(const DrivingPoint& record, const Matrix3& rigid, double radius) {
  const int growing = zeros_inside(record, rigid, radius);
  // Bisection for the circle that just reaches the first zero, in the logarithm of its distance:
  // most lie near the unit circle.
  const double sign = growing > 0 ? -1.0 : 1.0;
  const double widest = std::log(kLargest) / static_cast<double>(record.cols());
  double near = kNearest;
  double far = growing > 0 ? kInward : std::min(kOutward, widest);
  for (int i = 0; i < kPoleBisections; ++i) {
    const double middle = std::sqrt(near * far);
    const bool reached = zeros_inside(record, rigid, radius * std::exp(sign * middle)) > 0;
    (reached == (growing > 0) ? near : far) = middle;
  }
  return {growing, std::exp(-sign * std::sqrt(near * far)) / radius};
}

double held_stiffness(const DrivingPoint& record, const Matrix3& rigid) {
  const Matrix3 first = record.col(0).reshaped(3, 3);
  const Matrix3 compliance = 0.5 * (first + first.transpose()) + rigid;
  return 1.0 / Eigen::SelfAdjointEigenSolver<Matrix3>(compliance).eigenvalues()(0);
}

}  // namespace irdm::precompute
