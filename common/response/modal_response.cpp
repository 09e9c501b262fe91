#include "common/response/modal_response.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <random>

namespace irdm {
namespace {

// The answer to the step f = 1 from rest, q(dt) = b1 and q'(dt) = b2, gives the whole transition:
// q' is the answer to an impulse, and the equation of motion gives q''.
HeldForceOscillator from_step_response(double omega, double sigma, double b1, double b2) {
  const double omega2 = omega * omega;
  const double a11 = 1.0 - omega2 * b1;
  return {a11, b2, -omega2 * b2, a11 - 2.0 * sigma * b2, b1, b2};
}

// Power series of the step response, from the equation of motion term by term; in units of dt. For
// omega dt + 2 sigma dt < 1 the terms fall at least as fast as 1/n!.
HeldForceOscillator slow(double omega, double sigma, double dt) {
  const double w2 = omega * dt * omega * dt;
  const double h = sigma * dt;
  double before = 0.0;  // coefficient of t^(n-1)
  double last = 0.5;    // coefficient of t^n
  double q = last;
  double v = 2.0 * last;
  for (int n = 2; n < 24; ++n) {
    const double next = (-2.0 * h * n * last - w2 * before) / (n * (n + 1.0));
    before = last;
    last = next;
    q += next;
    v += (n + 1.0) * next;
  }
  return from_step_response(omega, sigma, q * dt * dt, v * dt);
}

HeldForceOscillator under_damped(double omega, double sigma, double dt) {
  const double damped = std::sqrt((omega - sigma) * (omega + sigma));
  const double decay = std::exp(-sigma * dt);
  const double sine = damped > 0.0 ? std::sin(damped * dt) / damped : dt;
  const double cosine = std::cos(damped * dt);
  const double a11 = decay * (cosine + sigma * sine);
  const double b2 = decay * sine;
  return {
      a11, b2, -omega * omega * b2, decay * (cosine - sigma * sine), (1.0 - a11) / omega / omega,
      b2};
}

// Two decaying exponentials with rates slow <= fast, slow fast = omega^2. Written so that neither
// slow (omega << sigma) nor the difference of the rates (sigma near omega) comes from a
// subtraction.
HeldForceOscillator over_damped(double omega, double sigma, double dt) {
  const double root = std::sqrt((sigma - omega) * (sigma + omega));
  const double fast = sigma + root;
  const double slow = omega * (omega / fast);
  const double spread = root > 0.0 ? -std::expm1(-2.0 * root * dt) / (2.0 * root) : dt;
  const double b2 = std::exp(-slow * dt) * spread;
  const double b1 = (-std::expm1(-slow * dt) / slow - b2) / fast;
  return {std::exp(-slow * dt) + slow * b2, b2, -slow * fast * b2,
          std::exp(-fast * dt) - slow * b2, b1, b2};
}

}  // namespace

HeldForceOscillator held_force_oscillator(double omega, double sigma, double dt) {
  assert(omega > 0.0 && sigma >= 0.0 && dt > 0.0);
  if ((omega + 2.0 * sigma) * dt < 1.0) return slow(omega, sigma, dt);
  return sigma < omega ? under_damped(omega, sigma, dt) : over_damped(omega, sigma, dt);
}

Eigen::VectorXd held_force_response(const HeldForceOscillator& oscillator, int steps) {
  const HeldForceOscillator& o = oscillator;
  Eigen::VectorXd h(steps);
  double q = o.b1;
  double v = o.b2;
  for (int s = 0; s < steps; ++s) {
    h(s) = q;
    const double next = o.a11 * q + o.a12 * v;
    v = o.a21 * q + o.a22 * v;
    q = next;
  }
  return h;
}

RowMatrix<double> held_responses(const ModalResponse& response, double dt, int steps) {
  RowMatrix<double> h(steps, response.mode_count());
  for (Eigen::Index i = 0; i < h.cols(); ++i) {
    h.col(i) = held_force_response(
        held_force_oscillator(response.angular_frequency(i), response.decay_rate(i), dt), steps);
  }
  return h;
}

namespace {

constexpr int kPowerRounds = 40;  // of the power iteration
// What the estimate may lack of the largest ratio.
constexpr double kMargin = 1.5;

// The omega dt of that ratio, which falls with it.
double oscillator_of(double ratio) {
  double low = 1e-6;
  double high = 10.0;
  for (int i = 0; i < 200; ++i) {
    const double middle = std::sqrt(low * high);
    (settling_ratio(middle) > ratio ? low : high) = middle;
  }
  return low;
}

Eigen::VectorXf random_direction(Eigen::Index size) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> uniform(-1.0F, 1.0F);
  Eigen::VectorXf v(size);
  for (float& value : v) value = uniform(random);
  return v.normalized();
}

}  // namespace

double settling_ratio(double x) {
  const HeldForceOscillator oscillator = held_force_oscillator(x, x, 1.0);
  return 1.0 / (x * x * oscillator.b1) - 1.0;
}

std::vector<double> settling_profile(double ratio, int steps) {
  std::vector<double> profile(static_cast<std::size_t>(steps), 0.0);
  if (steps < 2) return profile;
  const double x = oscillator_of(std::max(1.0, kMargin * ratio));
  const Eigen::VectorXd h = held_force_response(held_force_oscillator(x, x, 1.0), steps);
  const double sum = h.tail(steps - 1).sum();
  for (int s = 1; s < steps; ++s) profile[static_cast<std::size_t>(s)] = h[s] / sum;
  return profile;
}

double settling_ratio(const Eigen::Ref<const Eigen::MatrixXf>& first,
                      const Eigen::Ref<const Eigen::MatrixXf>& rest) {
  Eigen::VectorXf v = random_direction(first.rows());
  for (int round = 0; round < kPowerRounds; ++round) {
    const Eigen::VectorXf next = first * v + rest * v;
    if (!(next.norm() > 0.0F)) return 0.0;
    v = next.normalized();
  }
  const auto start = static_cast<double>(v.dot(first * v));
  return start > 0.0 ? std::max(0.0, static_cast<double>(v.dot(rest * v)) / start) : 0.0;
}

}  // namespace irdm
