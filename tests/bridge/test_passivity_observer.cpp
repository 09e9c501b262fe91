#include <limits>

#include "device_bridge/safety/passivity.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;

namespace {

const Vector3 kPush(0, 2.0, 0);

// The hand does this much work against the force [J].
void take_in(Passivity& passivity, double work) {
  passivity.observe({-work / kPush.squaredNorm() * kPush}, {kPush});
}

}  // namespace

TEST_CASE("passivity observer: energy is kept between its two bounds, however long one pushes") {
  const PassivityLimits limits;
  Passivity passivity(limits);
  take_in(passivity, 0.05);
  CHECK(passivity.energy() == Approx(0.05));
  for (int i = 0; i < 10'000; ++i) {
    take_in(passivity, 0.01);
    REQUIRE(passivity.energy() <= limits.most);
  }
  CHECK(passivity.energy() == limits.most);
  // Not blind after 100 J: what is given out counts from the bound on.
  take_in(passivity, -limits.most - 0.01);
  CHECK(passivity.energy() == Approx(-0.01));
  CHECK(passivity.damping({kPush}, {Vector3(0, 0.1, 0)}, 1e-3) > 0.0);
  for (int i = 0; i < 100; ++i) take_in(passivity, -0.01);
  CHECK(passivity.energy() == limits.least);
}

TEST_CASE("passivity observer: the account of both ends bounds what the device may give") {
  const PassivityLimits limits;
  Passivity passivity(limits);
  take_in(passivity, 0.05);
  passivity.bound(0.2);
  CHECK(passivity.energy() == Approx(0.05));
  passivity.bound(std::numeric_limits<double>::quiet_NaN());
  CHECK(passivity.energy() == Approx(0.05));
  passivity.bound(0.01);
  CHECK(passivity.energy() == 0.01);
  passivity.bound(-1.0);
  CHECK(passivity.energy() == limits.least);
  passivity.bound(0.2);
  CHECK(passivity.energy() == Approx(0.05));
}

TEST_CASE("passivity observer: ways and turns share one account, and are damped in proportion") {
  const Vector3 torque(0, 0, 0.1);
  Passivity passivity({});
  take_in(passivity, 0.01);
  passivity.observe({Vector3::Zero(), Vector3(0, 0, 0.2)}, {kPush, torque});
  CHECK(passivity.energy() == Approx(-0.01));
  // As much as makes up for 10 mJ in this tick: in both it takes this share of v^2 + lever^2 w^2.
  const Twist velocity{Vector3(0, 0, 0.5), Vector3(100.0, 0, 0)};
  const double damping = passivity.damping({kPush, torque}, velocity, 0.01);
  CHECK(damping * (0.25 + kLever * kLever * 1e4) * 0.01 == Approx(0.01));
}

TEST_CASE("passivity observer: what was given in excess makes a force of now fade") {
  const PassivityLimits limits;
  Passivity passivity(limits);
  CHECK((passivity.withheld(kPush) - kPush).norm() == 0.0);
  passivity.bound(-0.5 * limits.fade);
  CHECK((passivity.withheld(kPush) - 0.5 * kPush).norm() < 1e-12);
  passivity.bound(-limits.fade);
  CHECK(passivity.withheld(kPush).isZero(0.0));
}

TEST_CASE("passivity observer: an excess is forgiven without contact, and no more than that") {
  const PassivityLimits limits;
  Passivity passivity(limits);
  take_in(passivity, -0.01);
  passivity.forgive(0.25);
  CHECK(passivity.energy() == Approx(-0.01 + 0.25 * limits.forgiven));
  passivity.forgive(100.0);
  CHECK(passivity.energy() == 0.0);
  take_in(passivity, 0.01);
  passivity.forgive(1.0);
  CHECK(passivity.energy() == Approx(0.01));
}
