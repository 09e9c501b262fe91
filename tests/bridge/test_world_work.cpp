#include <cmath>

#include "common/motion/rigid_body.hpp"
#include "device_bridge/safety/passivity.hpp"
#include "tests/bridge/milliseconds.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;
using namespace irdm::test;

namespace {

constexpr int kDelay = 10;  // ticks

// A tip that goes by `way(t)` for a second, and the force `force(tip)` on it that comes kDelay
// later; what the world has given beyond what it took [J].
template <class Way, class Force>
double given(const Way& way, const Force& force) {
  WorldWork world;
  double sum = 0.0;
  for (int i = 0; i < 1000; ++i) {
    world.observe(i * kMs, Vector3(0, way(1e-3 * i), 0));
    if (i < kDelay) continue;
    const int then = i - kDelay;
    sum += world.answer(then * kMs, {Vector3(0, force(way(1e-3 * then)), 0)});
  }
  return sum;
}

double shaking(double t) {
  return 5e-3 * std::sin(2.0 * M_PI * 10.0 * t);
}

}  // namespace

TEST_CASE("world work: a passive world gives nothing of its own, however late its forces come") {
  CHECK(given(shaking, [](double tip) { return std::max(0.0, -500.0 * tip); }) < 1e-12);
}

TEST_CASE("world work: what another hand gives is the world's own, beyond what this one put in") {
  const auto push = [](double) { return 1.0; };
  const auto away = [](double t) { return 0.1 * t; };
  CHECK(given(away, push) == Approx(0.1 * (0.999 - kDelay * 1e-3)).epsilon(1e-9));
  // In by 3 cm first, and out by 5.
  const auto back = [](double t) { return t < 0.3 ? -0.1 * t : -0.03 + 0.1 * (t - 0.3); };
  CHECK(given(back, push) == Approx(0.1 * (0.989 - 0.6)).epsilon(1e-9));
}

TEST_CASE("world work: a spring against turns that is late gives nothing of its own") {
  constexpr double kSpring = 2.0;  // [N m/rad]
  const auto angle = [](double t) { return 0.3 * std::sin(2.0 * M_PI * 10.0 * t); };
  const auto given_by = [&](double own) {
    WorldWork world;
    double sum = 0.0;
    for (int i = 0; i < 1000; ++i) {
      world.observe(i * kMs, Vector3::Zero(), rotation_from_vector(Vector3(0, angle(1e-3 * i), 0)));
      if (i < kDelay) continue;
      const int then = i - kDelay;
      const double torque = std::max(0.0, -kSpring * angle(1e-3 * then)) + own;
      sum += world.answer(then * kMs, {Vector3::Zero(), Vector3(0, torque, 0)});
    }
    return sum;
  };
  CHECK(given_by(0.0) < 1e-12);
  CHECK(given_by(0.1) < 0.1 * 0.3 + 1e-12);  // first turned along with it, and then to and fro
  CHECK(given_by(0.1) > 0.0);
}

TEST_CASE("world work: what is old, of no tip that is remembered, or no number counts as nothing") {
  WorldWork world;
  const Vector3 push(0, 1, 0);
  CHECK(world.answer(0, {push}) == 0.0);
  world.observe(0, Vector3::Zero());
  world.observe(kMs, Vector3(0, 0.01, 0));
  CHECK(world.answer(-kMs, {push}) == 0.0);
  CHECK(world.answer(0, {push}) == 0.0);  // the first one has no way
  CHECK(world.answer(0, {push}) == 0.0);
  CHECK(world.answer(kMs, {push * std::nan("")}) == 0.0);
  CHECK(world.answer(kMs, {push}) == 0.0);
  world.observe(2 * kMs, Vector3(0, 0.02, 0));
  CHECK(world.answer(2 * kMs, {push}) == Approx(0.01));
  world.observe(60 * kMs, Vector3(0, 0.1, 0));  // after a silence
  CHECK(world.answer(60 * kMs, {push}) == 0.0);
}
