#include "precompute/modal/held_responses.hpp"

#include <cmath>

#include "common/response/oscillator.hpp"

namespace irdm::precompute {
namespace {

// R[s](a, a): (3n, T).
RowMatrix<double> driving_points(const ModalResponse& response, double dt, int steps) {
  const RowMatrix<double> squares = std::get<RowMatrix<double>>(response.shapes).array().square();
  return squares * held_responses(response, dt, steps).transpose();
}

// Bound of |q| of one mode at and after the end of step T-1.
double later_bound(const HeldForceOscillator& o, double omega, int steps) {
  double q = o.b1;
  double v = o.b2;
  for (int s = 1; s < steps; ++s) {
    const double next = o.a11 * q + o.a12 * v;
    v = o.a21 * q + o.a22 * v;
    q = next;
  }
  return std::hypot(q, v / omega);
}

}  // namespace

RowMatrix<double> held_responses(const ModalResponse& response, double dt, int steps) {
  RowMatrix<double> h(steps, response.mode_count());
  for (Eigen::Index i = 0; i < h.cols(); ++i) {
    h.col(i) = held_force_response(
        held_force_oscillator(response.angular_frequency(i), response.decay_rate(i), dt), steps);
  }
  return h;
}

double decay_left(const ModalResponse& response, double dt, int steps) {
  const auto& shapes = std::get<RowMatrix<double>>(response.shapes);
  const RowMatrix<double> squares = shapes.array().square();
  Eigen::VectorXd bound(response.mode_count());
  for (Eigen::Index i = 0; i < bound.size(); ++i) {
    const double omega = response.angular_frequency(i);
    bound(i) = later_bound(held_force_oscillator(omega, response.decay_rate(i), dt), omega, steps);
  }
  const Eigen::VectorXd peak = driving_points(response, dt, steps).cwiseAbs().rowwise().maxCoeff();
  const Eigen::VectorXd left = squares * bound;
  return (peak.array() > 0.0).select(left.cwiseQuotient(peak), 0.0).maxCoeff();  // 0: clamped
}

}  // namespace irdm::precompute
