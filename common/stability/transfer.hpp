#pragma once

#include <Eigen/Dense>
#include <complex>
#include <functional>
#include <vector>

#include "common/model/model.hpp"
#include "common/response/stored_response.hpp"

/// The z-transform of a node's own response on circles about the origin, and what can be read from
/// it. w = 1/z throughout: X(w) = sum_s x[s] w^s is analytic inside the unit circle, and a pole or
/// a zero there, |w| < 1, is one that grows by 1/|w| a step.
namespace irdm {

/// Values of a function of w at w_j = radius exp(-i pi j / half), j = 0..half: half a circle, the
/// other half is its complex conjugate.
using MatrixHalfCircle = std::vector<Eigen::Matrix3cd>;

/// w_j itself; j may lie between two points.
std::complex<double> circle_point(double radius, int half, double j);

/// sum_s R_ii[s] w^s by FFT; exact for any length of the record.
/// @param half a power of two
MatrixHalfCircle transform(const DrivingPoint& record, double radius, int half);

/// Points of a half circle that resolve a record of `length` steps: one a step, a power of two.
int resolving_half_circle(Eigen::Index length);

struct ZeroCount {
  int zeros = 0;
  /// Whether the function was followed round the circle. It is not where it is noise in too many
  /// places, which kMostTurns bounds the time for.
  bool resolved = true;
};

/// Values that are looked at between the points of a half circle, at most.
inline constexpr int kMostTurns = 1 << 16;

/// Number of zeros inside the circle of a function with real coefficients that is analytic there,
/// by the argument principle: how often its value goes round the origin. A zero near the circle
/// turns the value quickly: there the points are brought closer together.
/// @param response on a half circle of this radius; between its points it is interpolated (cubic)
/// @param value of the function where the response is this and w is that
ZeroCount count_zeros(const MatrixHalfCircle& response, double radius,
                      const std::function<std::complex<double>(const Eigen::Matrix3cd&,
                                                               std::complex<double>)>& value);

/// A record that is long enough to stand for one without end.
struct RecordLength {
  int steps;
  /// Of the circle that counts as the unit circle: what lies beyond the record weighs less than
  /// 1e-9 on it. 1 unless the modes hardly decay.
  double radius;
};
RecordLength record_length(const ModalResponse& response, double dt);
RecordLength record_length(const CompressedResponse& response);

}  // namespace irdm
