#include "precompute/modal/press.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace irdm::precompute {
namespace {

constexpr double kPressTime = 0.1;  // [s]

double indentation(double t, double time) {
  return 0.5 * (1.0 - std::cos(std::numbers::pi * std::min(t / time, 1.0)));
}

}  // namespace

double press_time(double dt) {
  return std::max(kPressTime, 10.0 * dt);
}

int press_steps(double dt) {
  return static_cast<int>(std::ceil(2.0 * press_time(dt) / dt));
}

Eigen::VectorXd press_force(const Eigen::VectorXd& response, double dt) {
  const int steps = press_steps(dt);
  Eigen::VectorXd force(steps);
  for (int k = 0; k < steps; ++k) {
    double past = 0.0;
    for (int s = 1; s <= k; ++s) past += response(s) * force(k - s);
    force(k) = (indentation((k + 1) * dt, press_time(dt)) - past) / response(0);
  }
  return force;
}

double press_error(const Eigen::VectorXd& all, const Eigen::VectorXd& found, double dt) {
  const Eigen::VectorXd expected = press_force(all, dt);
  return (press_force(found, dt) - expected).cwiseAbs().maxCoeff() / expected.cwiseAbs().maxCoeff();
}

}  // namespace irdm::precompute
