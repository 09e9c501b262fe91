#include "common/response/settling.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "common/response/oscillator.hpp"

namespace irdm {
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
