#include "tests/prediction/harsh_loop.hpp"

#include <algorithm>
#include <array>
#include <sstream>

#include "device_bridge/safety/arming.hpp"
#include "tests/prediction/dice.hpp"

namespace irdm::test {
namespace {

constexpr double kDuration = 1.5;  // [s]

// Up, down, and to the sides.
const std::array kFaces{Vector3(0, 1, 0), Vector3(0, -1, 0), Vector3(1, 0, 0), Vector3(0, 0, 1)};

LoopHand hand_on(const Vector3& face, Dice& dice) {
  const Vector3 across = Vector3(face.y(), face.z(), face.x());
  const double mass = dice.between(0.05, 0.3);
  const double stiffness = dice.over(30.0, 1000.0);
  LoopHand hand;
  hand.hand = {mass, dice.between(0.2, 1.0) * 2.0 * std::sqrt(mass * stiffness), stiffness};
  hand.grab = dice.coin();
  const double depth = hand.grab ? 0.0 : dice.between(0.002, 0.03);
  const double way = hand.grab || dice.coin() ? dice.between(0.0, 0.03) : 0.0;
  const double rate = dice.between(0.5, 2.5);
  const double above = hand.grab ? 0.0 : 0.004;
  hand.target = [=](double t) -> Vector3 {
    const double down = depth * smooth(t, 0.1, 0.3 + 0.2 / rate);
    const double sway = smooth(t, 0.3, 0.6) * std::sin(2 * M_PI * rate * (t - 0.3));
    return (kHalfEdge + above - down) * face + way * sway * across;
  };
  return hand;
}

}  // namespace

HarshLoop::HarshLoop(std::uint64_t seed) {
  Dice dice(seed);
  const auto hands = static_cast<std::size_t>(dice.between(1.0, 4.999));
  SimulationObject object;
  object.model = cube_of(static_cast<std::size_t>(dice.between(0.0, 6.999)));
  object.friction = {0.6, 0.5};
  setup.config.objects = {object};
  const bool floor = hands == 1 && dice.coin();
  if (floor) {
    setup.config.floor = FloorConfig{.height = -kHalfEdge};
    setup.config.gravity = Vector3(0, -9.81, 0);
  }
  setup.config.styluses.assign(hands, {0.0, dice.over(300.0, 2000.0), 0.005});
  for (std::size_t s = 0; s < hands; ++s) setup.hands.push_back(hand_on(kFaces[s], dice));
  setup.steps = static_cast<int>(kDuration / 0.002);
  setup.filtered = true;
  setup.needed_success = LinkGate::kNeeded;
  setup.seed = seed;
  link = {.delay = dice.between(0.0, 0.02),
          .jitter = dice.coin() ? dice.between(0.0, 0.01) : 0.0,
          .loss = dice.coin() ? dice.between(0.0, 0.1) : 0.0};
  const auto overruns = [&]() -> Overruns {
    if (dice.coin()) return {};
    return {.every = dice.over(0.02, 1.0), .longest = dice.between(0.0, 0.02)};
  };
  setup.server_overruns = overruns();
  setup.bridge_overruns = overruns();
  std::ostringstream text;
  text << "seed " << seed << ": " << hands << " hands, E " << object.model->material.youngs_modulus
       << " N/m^2" << (floor ? ", floor" : "") << "; one way " << 1e3 * link.delay << " ms, jitter "
       << 1e3 * link.jitter << " ms, loss " << 100 * link.loss << " %, overruns every "
       << setup.server_overruns.every << ", " << setup.bridge_overruns.every << " s";
  words = text.str();
}

}  // namespace irdm::test
