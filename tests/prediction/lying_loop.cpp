#include "tests/prediction/lying_loop.hpp"

#include <array>
#include <memory>
#include <sstream>

#include "device_bridge/safety/arming.hpp"
#include "tests/prediction/dice.hpp"

namespace irdm::test {
namespace {

constexpr double kLyingDuration = 1.5;  // [s]
constexpr double kStrong = kMostAppliedForce;

using Lie = std::function<AppliedForce(const AppliedForce&, const ObjectRecord&)>;

Vector3 direction(Dice& dice) {
  Vector3 vector;
  do {
    for (double& part : vector) part = dice.between(-1.0, 1.0);
  } while (vector.norm() < 0.1 || vector.norm() > 1.0);
  return vector.normalized();
}

// Up, down, and to the sides.
Vector3 face(std::size_t i) {
  return (i % 2 == 0 ? 1.0 : -1.0) * Vector3::Unit(static_cast<Eigen::Index>(i / 2 + 1) % 3);
}

// The tip is told to be off by so much [m], to and fro, and pushes along that way. The hand itself
// stands still by then.
Lie lie_about_tip(double off, double force, std::uint64_t seed) {
  auto dice = std::make_shared<Dice>(seed);
  auto side = std::make_shared<double>(1.0);
  return [=](const AppliedForce& truth, const ObjectRecord&) {
    *side = -*side;
    const Vector3 along = direction(*dice);
    return AppliedForce{*side * force * along, truth.tip + *side * off * along, truth.arm};
  };
}

// Along the velocity of the object at the contact, or against it for some steps.
Lie pump(double force, std::uint64_t seed) {
  auto dice = std::make_shared<Dice>(seed);
  return [=](const AppliedForce& truth, const ObjectRecord& object) {
    const Vector3 arm = object.orientation * truth.arm;
    const Vector3 velocity = object.velocity + object.angular_velocity.cross(arm);
    const Vector3 way = velocity.norm() > 1e-6 ? Vector3(velocity.normalized()) : direction(*dice);
    const double sign = dice->between(0.0, 1.0) < 0.2 ? -1.0 : 1.0;
    return AppliedForce{sign * force * way, truth.tip, truth.arm};
  };
}

// To and fro at the pace of the object's own motion, or any.
Lie shake(double force, int steps, std::uint64_t seed) {
  auto dice = std::make_shared<Dice>(seed);
  auto k = std::make_shared<int>(0);
  const Vector3 along = direction(*dice);
  return [=](const AppliedForce& truth, const ObjectRecord&) {
    const double sign = (*k)++ / steps % 2 == 0 ? 1.0 : -1.0;
    return AppliedForce{sign * force * along, truth.tip, truth.arm};
  };
}

// The truth at first, while the hand comes to its place.
Lie later(const Lie& lie) {
  constexpr int kTrue = 350;  // [steps]
  auto k = std::make_shared<int>(0);
  return [=](const AppliedForce& truth, const ObjectRecord& object) {
    return (*k)++ < kTrue ? truth : lie(truth, object);
  };
}

Lie any_lie(bool still, Dice& dice, std::uint64_t seed, std::ostringstream& words) {
  const double force = dice.over(1.0, kStrong);
  const double kind = dice.between(0.0, 3.0);
  if (still) {
    const double off = dice.over(1e-4, 1000.0);
    words << "; a lie of " << off << " m at " << force << " N";
    return later(lie_about_tip(off, force, seed));
  }
  if (kind < 1.5) {
    words << "; a pump of " << force << " N";
    return pump(force, seed);
  }
  const int steps = static_cast<int>(dice.between(1.0, 50.0));
  words << "; " << force << " N to and fro every " << steps << " steps";
  return shake(force, steps, seed);
}

LoopHand hand_at(const Vector3& out, bool grab, bool still, Dice& dice) {
  const Vector3 across(out.y(), out.z(), out.x());
  const double mass = dice.between(0.05, 0.3);
  const double stiffness = dice.over(30.0, 1000.0);
  LoopHand hand;
  hand.hand = {mass, dice.between(0.2, 1.0) * 2.0 * std::sqrt(mass * stiffness), stiffness};
  hand.grab = grab;
  const double depth = grab ? 0.0 : dice.between(0.002, 0.02);
  const double above = grab ? 0.0 : 0.004;
  const double sway = !still && dice.coin() ? dice.between(0.0, 0.02) : 0.0;
  const double rate = dice.between(0.5, 2.0);
  hand.target = [=](double t) -> Vector3 {
    const double down = depth * smooth(t, 0.1, 0.4);
    const double aside = sway * smooth(t, 0.3, 0.6) * std::sin(2 * M_PI * rate * (t - 0.3));
    return (kHalfEdge + above - down) * out + aside * across;
  };
  return hand;
}

}  // namespace

LyingLoop::LyingLoop(std::uint64_t seed) {
  Dice dice(seed);
  std::ostringstream text;
  honest = dice.coin() ? 1 : 2;
  const auto liars = static_cast<std::size_t>(dice.between(1.0, 4.999));
  SimulationObject object;
  object.model = cube_of(static_cast<std::size_t>(dice.between(0.0, 6.999)));
  object.friction = {0.6, 0.5};
  setup.config.objects = {object};
  setup.config.styluses.assign(honest + liars, {0.0, dice.over(300.0, 2000.0), 0.005});
  setup.steps = static_cast<int>(kLyingDuration / 0.002);
  setup.filtered = true;
  setup.needed_success = LinkGate::kNeeded;
  setup.seed = seed;
  stalls = dice.coin();
  text << "seed " << seed << ": E " << object.model->material.youngs_modulus << " N/m^2, " << honest
       << " honest" << (stalls ? ", stalls" : "");
  for (std::size_t s = 0; s < honest + liars; ++s) {
    const bool still = s >= honest && dice.between(0.0, 1.0) < 0.4;
    setup.hands.push_back(hand_at(face(s), dice.coin(), still, dice));
    if (s >= honest) setup.hands.back().lie = any_lie(still, dice, 100 * seed + s, text);
  }
  link = {.delay = dice.between(0.0, 0.01), .jitter = dice.coin() ? dice.between(0.0, 0.005) : 0.0};
  if (stalls) {
    setup.server_overruns = {.every = dice.over(0.02, 1.0), .longest = 0.02};
    setup.bridge_overruns = {.every = dice.over(0.02, 1.0), .longest = 0.02};
  }
  words = text.str();
}

}  // namespace irdm::test
