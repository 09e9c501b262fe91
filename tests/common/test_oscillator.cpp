#include <array>
#include <cmath>

#include "common/response/modal_response.hpp"
#include "tests/support/catch.hpp"

using irdm::held_force_oscillator;
using irdm::held_force_response;
using irdm::HeldForceOscillator;

namespace {

struct Case {
  double omega, sigma, dt;
};

// Under-, critically and over-damped, near critical, tiny and large steps.
constexpr std::array<Case, 14> kCases{{{67.0, 4.45, 0.002},
                                       {67.0, 0.0, 0.002},
                                       {9000.0, 8100.0, 0.002},
                                       {500.0, 500.0, 0.002},
                                       {500.0, 500.0 * (1 + 1e-9), 0.002},
                                       {500.0, 500.0 * (1 - 1e-9), 0.002},
                                       {12000.0, 14400.0, 0.002},
                                       {1e-3, 4.0, 0.002},
                                       {1e-4, 2000.0, 0.002},
                                       {300.0, 250.0, 0.002},
                                       {499.0, 0.4, 0.002},
                                       {200.0, 200.0, 0.002},
                                       {3.0, 1e-3, 1e-6},
                                       {2000.0, 3.0, 0.01}}};

using Matrix3L = Eigen::Matrix<long double, 3, 3>;

// Independent reference: exp of the generator of (q, v, f) by its power series over dt / 2^k in
// long double, squared k times. Returns the transition minus identity, which keeps small entries.
Matrix3L transition_minus_identity(const Case& c) {
  Matrix3L generator = Matrix3L::Zero();
  const long double dt = c.dt;
  generator(0, 1) = 1.0L * dt;
  generator(1, 0) = -dt * c.omega * c.omega;
  generator(1, 1) = -2.0L * dt * c.sigma;
  generator(1, 2) = dt;
  int halvings = 0;
  while (generator.cwiseAbs().maxCoeff() > 0.01L) {
    generator /= 2.0L;
    ++halvings;
  }
  Matrix3L term = generator;
  Matrix3L sum = generator;
  for (int n = 2; n < 16; ++n) {
    term = Matrix3L(term * generator) / static_cast<long double>(n);
    sum += term;
  }
  for (int i = 0; i < halvings; ++i) sum = Matrix3L(2.0L * sum + sum * sum);
  return sum;
}

}  // namespace

TEST_CASE("held-force oscillator is the exact transition for every damping and step") {
  for (const Case& c : kCases) {
    CAPTURE(c.omega, c.sigma, c.dt);
    const HeldForceOscillator o = held_force_oscillator(c.omega, c.sigma, c.dt);
    const Matrix3L reference = transition_minus_identity(c);
    const auto entry = [&](int i, int j) { return static_cast<double>(reference(i, j)); };
    CHECK(o.b1 == Approx(entry(0, 2)).epsilon(2e-13));
    CHECK(o.b2 == Approx(entry(1, 2)).epsilon(2e-13));
    CHECK(o.a12 == Approx(entry(0, 1)).epsilon(2e-13));
    CHECK(o.a21 == Approx(entry(1, 0)).epsilon(2e-13));
    CHECK(std::abs(o.a11 - 1.0 - entry(0, 0)) < 1e-14);
    CHECK(std::abs(o.a22 - 1.0 - entry(1, 1)) < 1e-14);
  }
}

TEST_CASE("responses to a held force sum up to the static compliance") {
  for (const Case& c : {kCases[0], kCases[2], kCases[4], kCases[6], kCases[9]}) {
    CAPTURE(c.omega, c.sigma, c.dt);
    const auto h = held_force_response(held_force_oscillator(c.omega, c.sigma, c.dt), 20000);
    CHECK(h.sum() * c.omega * c.omega == Approx(1.0).epsilon(1e-12));
  }
}

TEST_CASE("responses to a held force are the step response minus itself one step later") {
  const Case c{67.0, 4.45, 0.002};
  const auto h = held_force_response(held_force_oscillator(c.omega, c.sigma, c.dt), 500);
  const double damped = std::sqrt(c.omega * c.omega - c.sigma * c.sigma);
  const auto step = [&](double t) {
    return (1.0 - std::exp(-c.sigma * t) *
                      (std::cos(damped * t) + c.sigma / damped * std::sin(damped * t))) /
           (c.omega * c.omega);
  };
  for (int s = 0; s < 500; ++s) {
    CHECK(h(s) == Approx(step((s + 1) * c.dt) - step(s * c.dt)).margin(1e-17));
  }
}
