#include "tests/prediction/random_loop.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "device_bridge/safety/arming.hpp"
#include "tests/prediction/dice.hpp"

namespace irdm::test {
namespace {

constexpr double kRest = 1.2;  // when the hand's wish comes to rest [s]
constexpr double kEnd = 3.0;   // [s]

// Held: goes aside and to and fro. Touching: presses down, and perhaps goes aside.
std::function<Vector3(double)> motion(bool held, Dice& dice) {
  const Vector3 at(dice.between(-0.03, 0.03), kHalfEdge, dice.between(-0.03, 0.03));
  const Vector3 aside(dice.between(-0.03, 0.03), 0.0, dice.between(-0.03, 0.03));
  const double rate = dice.between(0.5, 2.5);
  const double depth = dice.between(0.002, 0.03);
  const double share = dice.coin() ? 1.0 : 0.0;
  if (held) {
    return [=](double t) -> Vector3 {
      const double sway = smooth(t, 0.1, 0.4) - smooth(t, kRest - 0.3, kRest);
      return at + sway * std::sin(2 * M_PI * rate * (t - 0.1)) * aside;
    };
  }
  return [=](double t) -> Vector3 {
    const double down = depth * smooth(t, 0.1, 0.3 + 0.2 / rate);
    return at + Vector3(0, 0.004 - down, 0) + share * smooth(t, 0.5, kRest) * aside;
  };
}

}  // namespace

RandomLoop::RandomLoop(std::uint64_t seed, bool near) {
  Dice dice(seed);
  const double mass = dice.between(0.05, 0.3);
  const double stiffness = dice.over(30.0, 1000.0);
  const double damping = dice.between(0.2, 1.0) * 2.0 * std::sqrt(mass * stiffness);
  const bool held = dice.coin();
  const bool tethered = dice.coin() || !held;
  setup.config.objects.resize(1);
  setup.config.objects[0].model = cube_of(seed);
  setup.config.objects[0].friction = {0.6, 0.5};
  if (tethered) {
    setup.config.objects[0].tether = {dice.over(50.0, 1000.0), dice.over(0.5, 10.0)};
    setup.config.objects[0].damping = {dice.between(2.0, 20.0), dice.between(2.0, 20.0)};
  }
  const double coupling = near ? dice.over(100.0, 400.0) : dice.over(300.0, 2000.0);
  setup.config.styluses = {{0.0, coupling, 0.005}};
  setup.hands.push_back({{mass, damping, stiffness}, motion(held, dice), held});
  setup.steps = static_cast<int>(kEnd / 0.002);
  setup.filtered = true;
  setup.needed_success = LinkGate::kNeeded;
  link = {.delay = dice.between(0.0, 0.01),
          .jitter = dice.coin() ? dice.between(0.0, 0.01) : 0.0,
          .loss = dice.coin() ? dice.between(0.0, 0.05) : 0.0};
  if (near) {
    link.delay *= 0.05;
    link.jitter *= 0.05;
  }
  std::ostringstream text;
  text << "seed " << seed << ": E " << setup.config.objects[0].model->material.youngs_modulus
       << " N/m^2, " << (held ? "held" : "touching") << (tethered ? ", tethered" : "") << ", k_vc "
       << coupling << " N/m; hand " << mass << " kg, " << damping << " N s/m, " << stiffness
       << " N/m; one way " << 1e3 * link.delay << " ms, jitter " << 1e3 * link.jitter
       << " ms, loss " << 100 * link.loss << " %";
  words = text.str();
}

Unrest unrest(const LoopRun& run, double dt) {
  const auto count = static_cast<std::size_t>(0.2 / dt);
  const auto& tip = run.tip[0];
  double sum = 0.0;
  for (std::size_t k = tip.size() - count; k < tip.size(); ++k) {
    sum += ((tip[k] - tip[k - 1]) / dt).squaredNorm();
  }
  return {std::sqrt(sum / static_cast<double>(count))};
}

}  // namespace irdm::test
