#include "precompute/modal/smooth_cut.hpp"

#include <cmath>
#include <numbers>

namespace irdm::precompute {
namespace {

constexpr double kFull = 0.25;  // of omega^2: up to here modes are whole

}  // namespace

double kept_share(double omega, double cut_off) {
  const double x = omega * omega / (cut_off * cut_off);
  if (x <= kFull) return 1.0;
  if (x >= 1.0) return 0.0;
  return 0.5 + 0.5 * std::cos(std::numbers::pi * (x - kFull) / (1.0 - kFull));
}

ModalResponse smoothly_cut(const ModalResponse& modes, int count) {
  const double cut_off = modes.angular_frequency(count);
  Eigen::VectorXd root(count);
  for (int i = 0; i < count; ++i) {
    root(i) = std::sqrt(kept_share(modes.angular_frequency(i), cut_off));
  }
  ModalResponse kept;
  kept.angular_frequency = modes.angular_frequency.head(count);
  kept.decay_rate = modes.decay_rate.head(count);
  kept.shapes = RowMatrix<double>(std::get<RowMatrix<double>>(modes.shapes).leftCols(count) *
                                  root.asDiagonal());
  if (modes.centrifugal.rows() > 0) {
    kept.centrifugal = root.asDiagonal() * modes.centrifugal.topRows(count);
  }
  if (modes.gravity.rows() > 0) kept.gravity = root.asDiagonal() * modes.gravity.topRows(count);
  kept.residual.reduction.cut_off = cut_off;
  return kept;
}

}  // namespace irdm::precompute
