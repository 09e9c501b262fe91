#include "device_bridge/servo_loop.hpp"
#include "tests/openhaptics/fake_session.hpp"
#include "tests/support/catch.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::test;

namespace {

constexpr unsigned kNeedsUpdate = 0x5001;
constexpr unsigned kNeedsPerson = 0x5002;
constexpr int kEncoderReset = 1;
constexpr int kAuto = 2;
constexpr int kInkwell = 4;
constexpr int kLook = hd::Calibration::kPeriodNs / 1'000'000;
const Vector3 kForce(0, 1, 0);

}  // namespace

TEST_CASE("calibration is asked for some times a second, and never in a frame") {
  const FakeSession session;
  SteppedDevice stepped;
  stepped.tick(1000);
  CHECK(fakehd_calibration_checks("") >= 2);
  CHECK(fakehd_calibration_checks("") <= 10);
}

TEST_CASE("a device that calibrates itself goes on doing so with its force on") {
  const FakeSession session;
  fakehd_calibration("", kNeedsUpdate,
                     GENERATE(as<int>{}, kAuto, kAuto | kInkwell | kEncoderReset));
  SteppedDevice stepped;
  stepped.wanted = kForce;
  CHECK(fakehd_updated_style("") == kAuto);
  for (int refined = 0; refined < 3; ++refined) {
    for (int tick = 0; tick < kLook; ++tick) {
      stepped.tick();
      REQUIRE(stepped.device.state().ready);
      REQUIRE(force_of("") == kForce);
    }
    fakehd_calibration("", kNeedsUpdate, kAuto);
    stepped.tick(kLook);
    CHECK(stepped.device.state().ready);
    CHECK(stepped.device.trouble().empty());
  }
}

TEST_CASE("a device with an inkwell has no force until its stylus was in it, and says so") {
  const FakeSession session;
  fakehd_calibration("", kNeedsPerson, GENERATE(as<int>{}, kInkwell, kInkwell | kEncoderReset));
  SteppedDevice stepped;
  stepped.wanted = kForce;
  stepped.tick(2 * kLook);
  CHECK_FALSE(stepped.device.state().ready);
  CHECK(fakehd_updated_style("") == 0);
  CHECK(force_of("").isZero(0.0));
  CHECK_THAT(stepped.device.trouble(), ContainsSubstring("inkwell"));
  fakehd_calibration("", kNeedsUpdate, kInkwell);  // it is in
  stepped.tick(2 * kLook);
  CHECK(fakehd_updated_style("") == kInkwell);
  CHECK(stepped.device.state().ready);
  CHECK(stepped.device.trouble().empty());
  CHECK(force_of("") == kForce);
}

TEST_CASE("encoders are never reset by the bridge: a person is told what to do") {
  const FakeSession session;
  fakehd_calibration("", GENERATE(as<unsigned>{}, kNeedsUpdate, kNeedsPerson), kEncoderReset);
  SteppedDevice stepped;
  stepped.wanted = kForce;
  stepped.tick(2 * kLook);
  CHECK(fakehd_updated_style("") == 0);
  CHECK_FALSE(stepped.device.state().ready);
  CHECK(force_of("").isZero(0.0));
  CHECK_THAT(stepped.device.trouble(), ContainsSubstring("reset pose"));
}

TEST_CASE("a calibration that fails is not a device that is lost: its force comes back later") {
  const FakeSession session;
  fakehd_calibration("", kNeedsUpdate, kAuto);
  SteppedDevice stepped;
  stepped.wanted = kForce;
  stepped.tick(kLook);
  REQUIRE(stepped.device.state().ready);
  fakehd_calibration_fails("", 1);
  stepped.tick(kLook);
  CHECK_FALSE(stepped.device.state().ready);
  CHECK_FALSE(stepped.device.state().failed);
  CHECK_FALSE(stepped.device.state().lost);
  CHECK(force_of("").isZero(0.0));
  CHECK_THAT(stepped.device.trouble(), ContainsSubstring("calibration fails"));
  fakehd_calibration_fails("", 0);
  stepped.tick(kLook);
  CHECK(stepped.device.state().ready);
  CHECK(stepped.device.trouble().empty());
  // Outside of a look the same error is a device that is lost.
  fakehd_raise_at_end("", 0x0300);
  stepped.tick();
  CHECK(stepped.device.state().lost);
}

TEST_CASE("positions that jump by a calibration drop the force, which comes back as a ramp") {
  const FakeSession session;
  fakehd_calibration_moves("", 20.0);
  SteppedLoop stepped;
  stepped.engage(kForce);
  fakehd_calibration("", kNeedsUpdate, kAuto);
  double least = 1.0;
  double rise = 0.0;
  for (int tick = 0; tick < 1000; ++tick) {
    const double before = force_of("").norm();
    stepped.tick(1, kForce);
    least = std::min(least, force_of("").norm());
    rise = std::max(rise, force_of("").norm() - before);
  }
  CHECK(stepped.loop.counts().trips == 1);
  CHECK(least == 0.0);
  CHECK(rise < 0.0021);  // in 0.5 s
  CHECK(force_of("").isApprox(kForce));
}
