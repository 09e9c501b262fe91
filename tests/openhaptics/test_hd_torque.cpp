// Torque of devices with six actuated axes (Premium 6DOF).
#include <cmath>

#include "tests/openhaptics/fake_session.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;
using namespace irdm::test;

TEST_CASE("a device with six actuated axes renders torque, in N m from and to mN m") {
  const FakeSession session;
  fakehd_six_axes("", 515.0, 188.0);
  SteppedDevice stepped;
  CHECK(stepped.device.rating().peak_torque == Approx(0.515));
  CHECK(stepped.device.rating().continuous_torque == Approx(0.188));
  stepped.wanted = Vector3(0.1, 0.2, 0.3);
  stepped.wanted_torque = Vector3(0.01, -0.02, 0.03);
  stepped.tick();
  CHECK(force_of("") == stepped.wanted);
  CHECK(torque_of("").isApprox(stepped.wanted_torque));
  SECTION("what is not finite is none of both") {
    stepped.wanted_torque.x() = std::nan("");
    stepped.tick();
    CHECK(force_of("").isZero(0.0));
    CHECK(torque_of("").isZero(0.0));
  }
  SECTION("nor is there any without calibration") {
    fakehd_calibration("", 0x5002, 4);
    stepped.tick(300);
    CHECK(force_of("").isZero(0.0));
    CHECK(torque_of("").isZero(0.0));
  }
}

TEST_CASE("a device with three actuated axes is never asked for a torque") {
  const FakeSession session;  // in which that would be a misuse
  SteppedDevice stepped;
  CHECK(stepped.device.rating().peak_torque == 0.0);
  stepped.wanted_torque = Vector3(0.01, -0.02, 0.03);
  stepped.tick(10);
  CHECK(torque_of("").isZero(0.0));
}

TEST_CASE("a torque of the server's goes through the filter to the device, and ends with a fault") {
  const FakeSession session;
  fakehd_six_axes("", 515.0, 188.0);
  SteppedLoop stepped({.max_torque = 0.15});
  const Vector3 force(0, 1, 0);
  stepped.engage(force);
  CHECK(torque_of("").isZero(0.0));  // none until a tool asks for one
  stepped.input.force.torque = Vector3(0, 0, 0.1);
  stepped.tick(1, force);
  CHECK(torque_of("").norm() == Approx(0.015));  // at the filter's rate
  stepped.tick(20, force);
  CHECK(torque_of("").isApprox(Vector3(0, 0, 0.1)));
  stepped.input.force.torque = Vector3(0, 0, 1.0);
  stepped.tick(20, force);
  CHECK(torque_of("").isApprox(Vector3(0, 0, 0.15)));
  fakehd_raise_at_end("", 0x0304);
  stepped.tick(50, force);
  CHECK(stepped.device.state().failed);
  CHECK(torque_of("").isZero(0.0));
}
