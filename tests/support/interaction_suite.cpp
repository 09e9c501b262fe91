#include "tests/support/interaction_suite.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace irdm::test {
namespace {

constexpr double kHalf = 0.06;
constexpr double kAbove = 0.004;
constexpr double kTurn = 2.0 * std::numbers::pi;
const std::array<std::string, 5> kKinds{"press", "tap", "slide", "swing", "pinch"};

class EvenNumbers {
 public:
  explicit EvenNumbers(int seed) : random_(static_cast<unsigned>(seed)) {}
  // Not std::uniform_real_distribution, which differs from library to library.
  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(random_()) / 4294967295.0;
  }

 private:
  std::mt19937 random_;
};

double smooth(double t) {
  const double x = std::clamp(t, 0.0, 1.0);
  return x * x * (3.0 - 2.0 * x);
}

double inward_way(const Interaction& what, double t) {
  if (what.kind == "tap") {
    return (what.depth + kAbove) * 0.5 * (1.0 - std::cos(kTurn * what.rate * t)) - kAbove;
  }
  const double pressed = smooth(t * what.rate) - smooth((t - 0.75) * what.rate);
  return (what.depth + kAbove) * pressed - kAbove;
}

Vector3 tip(const Interaction& what, std::size_t s, double t) {
  Vector3 x = what.place[s];
  if (what.kind == "swing") {
    x += what.inward[s] * (0.003 * smooth(t / 0.05) - 0.001);
    return x + what.aside * what.way * std::sin(kTurn * what.rate * std::max(0.0, t - 0.1)) *
                   smooth((t - 0.1) / 0.2);
  }
  x += what.inward[s] * inward_way(what, t);
  if (what.kind == "slide") x += what.aside * what.way * smooth((t - 0.2) / 0.5);
  return x;
}

}  // namespace

std::array<StylusCommand, 2> Interaction::commands(int k, double dt) const {
  const double t = (k + 1) * dt;
  std::array<StylusCommand, 2> commands;
  for (std::size_t s = 0; s < styluses.size(); ++s) {
    commands[s].present = true;
    commands[s].tip = tip(*this, s, t);
    if (kind == "swing" && t > 0.06 && t < 0.8) commands[s].buttons = kGrabButton;
  }
  return commands;
}

Interaction interaction(int number) {
  EvenNumbers random(number + 1);
  Interaction what;
  what.kind = kKinds[static_cast<std::size_t>(number) % kKinds.size()];
  const std::size_t count = what.kind == "pinch" ? 2 : 1;
  const double radius = number / 5 % 2 == 0 ? 0.0 : random.between(0.006, 0.015);
  what.styluses.assign(count, {radius, 0.0, 0.008});
  const auto axis = static_cast<Eigen::Index>(number / 5 % 3);
  const double side = random.between(0.0, 1.0) < 0.5 ? -1.0 : 1.0;
  for (std::size_t s = 0; s < 2; ++s) {
    const double face = s == 0 ? side : -side;
    what.place[s] = Vector3(random.between(-0.04, 0.04), random.between(-0.04, 0.04),
                            random.between(-0.04, 0.04));
    what.place[s][axis] = face * kHalf;
    what.inward[s] = -face * Vector3::Unit(axis);
  }
  if (what.kind == "pinch") {
    what.place[1] = what.place[0];
    what.place[1][axis] = -side * kHalf;
  }
  // Towards the middle of the face, so that a slide stays on it.
  what.aside = -what.place[0] + what.place[0][axis] * Vector3::Unit(axis);
  what.aside.normalize();
  what.depth = random.between(0.003, 0.012);
  what.way = what.kind == "swing" ? random.between(0.02, 0.05) : random.between(0.015, 0.03);
  what.rate = what.kind == "swing" ? random.between(0.8, 2.5) : random.between(3.0, 8.0);
  return what;
}

ForceTrace run_interaction(const Interaction& what, std::shared_ptr<const Model> model,
                           double seconds) {
  SimulationConfig config;
  config.objects.resize(1);
  SimulationObject& object = config.objects[0];
  object.model = std::move(model);
  object.friction = {0.6, 0.5};
  object.damping = {2.0, 2.0};
  object.tether = {40.0, 0.05};
  config.styluses = what.styluses;
  Simulation simulation(config);
  StepRecord record;
  ForceTrace trace;
  const int steps = static_cast<int>(std::lround(seconds / simulation.dt()));
  for (int k = 0; k < steps; ++k) {
    const auto commands = what.commands(k, simulation.dt());
    simulation.step({commands.data(), what.styluses.size()}, record);
    trace.emplace_back();
    for (std::size_t s = 0; s < 2; ++s) {
      trace.back()[s] = s < what.styluses.size() ? record.stylus[s].force : Vector3::Zero();
    }
  }
  return trace;
}

ForceDifference compare(const ForceTrace& expected, const ForceTrace& actual) {
  ForceDifference result;
  double squares = 0.0;
  double difference_squares = 0.0;
  std::vector<double> differences;
  for (std::size_t k = 0; k < expected.size(); ++k) {
    double larger = 0.0;
    for (std::size_t s = 0; s < 2; ++s) {
      const double difference = (actual[k][s] - expected[k][s]).norm();
      result.peak = std::max(result.peak, expected[k][s].norm());
      larger = std::max(larger, difference);
      squares += expected[k][s].squaredNorm();
      difference_squares += difference * difference;
    }
    differences.push_back(larger);
  }
  const double peak = std::max(result.peak, 1e-30);
  for (const double difference : differences) {
    result.largest = std::max(result.largest, difference / peak);
    if (difference > 0.01 * peak) ++result.above;
  }
  result.rms = std::sqrt(difference_squares / std::max(squares, 1e-60));
  return result;
}

}  // namespace irdm::test
