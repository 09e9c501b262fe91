#include <sstream>

#include "device_bridge/virtual_stylus.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;

namespace {

StylusScript script() {
  std::istringstream text("time,x,y,z,button\n0,0,0,0,0\n1,0.1,0,0,1\n");
  return StylusScript::parse(text, "motion.csv");
}

}  // namespace

TEST_CASE("virtual stylus without a hand moves exactly as scripted, whatever the force") {
  VirtualStylus stylus(script());
  stylus.write({Vector3(0, 9, 0)});
  CHECK(stylus.read(0.5).tip.isApprox(Vector3(0.05, 0, 0)));
  CHECK(stylus.read(1.0).buttons == 1);
  CHECK(stylus.duration() == 1.0);
  CHECK(stylus.simulated());
}

TEST_CASE("virtual stylus with a hand follows the script and gives way to the force") {
  VirtualStylus stylus(script(), HandParameters{});
  stylus.write({Vector3(0, 3, 0)});
  CHECK(stylus.read(0.0).tip == Vector3::Zero());
  for (int tick = 1; tick <= 5000; ++tick) stylus.read(1e-3 * tick);
  CHECK((stylus.read(5.0).tip - Vector3(0.1, 0.01, 0)).norm() < 1e-9);
}

TEST_CASE("virtual stylus: the hand is let go when no force comes, to the moment") {
  const MotorParameters watched{.watchdog = 0.032};
  VirtualStylus stylus(script(), HandParameters{}, {}, watched);
  VirtualHand hand(HandParameters{}, Vector3::Zero());
  const Vector3 force(0, 1, 0);
  stylus.write({force});
  const Vector3 found = stylus.read(0.1).tip;
  hand.advance(0.032, script().at(0.032).tip, force);
  hand.advance(0.068, script().at(0.1).tip, Vector3::Zero());
  CHECK(found.isApprox(hand.position(), 1e-12));
  // With a force each millisecond nobody is let go.
  VirtualStylus served(script(), HandParameters{}, {}, watched);
  VirtualStylus plain(script(), HandParameters{});
  for (int tick = 1; tick <= 500; ++tick) {
    served.write({force});
    plain.write({force});
    REQUIRE(served.read(1e-3 * tick).tip == plain.read(1e-3 * tick).tip);
  }
}

TEST_CASE("virtual stylus: the hand feels what the motors show, and its sensor what it measures") {
  VirtualStylus stylus(script(), HandParameters{}, {.resolution = 0.001}, {.max_force = 3.0});
  stylus.write({Vector3(0, 30, 0)});
  for (int tick = 1; tick <= 5000; ++tick) stylus.read(1e-3 * tick);
  // 3 N against 300 N/m.
  CHECK(stylus.read(5.0).tip.isApprox(Vector3(0.1, 0.01, 0), 1e-12));
  CHECK(stylus.rating().peak == 3.0);
}

TEST_CASE("virtual stylus: a hand with an inertia feels torque, as far as the motors show it") {
  const Vector3 torque(0, 0, 0.3);
  const HandParameters turned{.turn = TurnParameters{}};
  VirtualStylus stylus(script(), turned, {}, {.max_torque = 0.15});
  CHECK(stylus.rating().peak_torque == 0.15);
  stylus.write({Vector3::Zero(), torque});
  for (int tick = 1; tick <= 5000; ++tick) stylus.read(1e-3 * tick);
  const Quaternion found = stylus.read(5.0).orientation;
  CHECK(found.angularDistance(Quaternion(Eigen::AngleAxisd(0.2, Vector3::UnitZ()))) < 1e-7);
  // Others are turned as scripted.
  VirtualStylus other(script(), HandParameters{});
  CHECK(other.rating().peak_torque == 0.0);
  other.write({Vector3::Zero(), torque});
  other.read(1.0);
  CHECK(other.read(2.0).orientation.coeffs() == Quaternion::Identity().coeffs());
}

TEST_CASE("virtual stylus: warm motors are told to the filter and to people") {
  VirtualStylus stylus(script(), {}, {}, {.continuous_force = 1.0, .time_constant = 1.0});
  CHECK(stylus.rating().continuous == 1.0);
  double last = 0.0;
  for (int tick = 1; tick <= 1000; ++tick) {
    stylus.write({Vector3(0, 2, 0)});
    stylus.read(1e-3 * tick);
    REQUIRE(stylus.state().motor_temperature >= last);
    last = stylus.state().motor_temperature;
    CHECK(stylus.trouble().empty() == (last < 1.0));
  }
  CHECK(last == 1.0);
  CHECK_THAT(stylus.trouble(), Catch::Matchers::ContainsSubstring("motors are warm"));
}
