#include "tests/openhaptics/fake_session.hpp"
#include "tests/support/catch.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::test;

namespace {

using hd::DriverWarnings;

constexpr int kPauseTicks = DriverWarnings::kPauseNs / kMs;  // of 1 ms
constexpr int kOftenTicks = DriverWarnings::kOftenNs / kMs;
const Vector3 kLargeForce(0, 2, 0);

// Until the pause is over, and the force is back.
void come_back(SteppedLoop& stepped) {
  stepped.tick(kPauseTicks + 600, kLargeForce);
  REQUIRE(force_of("").isApprox(kLargeForce));
}

}  // namespace

TEST_CASE(
    "warnings of a driver: what goes on is one of them, and the third in ten seconds latches") {
  DriverWarnings warnings;
  const auto ticks = [&](int count) {
    for (int k = 0; k < count; ++k) warnings.tick(kMs);
  };
  CHECK_FALSE(warnings.paused());
  // A hand that is too fast for a second.
  for (int k = 0; k < 1000; ++k, ticks(1)) REQUIRE(warnings.bearable(true));
  ticks(kPauseTicks - 2);
  CHECK(warnings.paused());
  ticks(1);
  CHECK_FALSE(warnings.paused());
  CHECK(warnings.bearable(true));
  SECTION("soon") {
    ticks(kOftenTicks / 2);
    CHECK_FALSE(warnings.bearable(true));
  }
  SECTION("without a force they do not count") {
    for (int k = 0; k < 10; ++k) {
      ticks(kPauseTicks);
      CHECK(warnings.bearable(false));
      CHECK(warnings.paused());
    }
  }
  SECTION("not so soon") {
    ticks(kOftenTicks / 2);
    for (int k = 0; k < 10; ++k) {
      ticks(kOftenTicks / 2 + 1);
      CHECK(warnings.bearable(true));
    }
  }
}

TEST_CASE("a force that the driver warns of fades, and comes back as a ramp after a pause") {
  const unsigned code = GENERATE(0x0201u, 0x0202u, 0x0203u);
  const bool at_begin = GENERATE(true, false);
  const FakeSession session;
  SteppedLoop stepped;
  stepped.engage(kLargeForce);
  at_begin ? fakehd_raise_at_begin("", code) : fakehd_raise_at_end("", code);
  stepped.tick(1, kLargeForce);
  CHECK(force_of("").norm() > 0.5);  // a step to zero would be a force that changed too fast
  stepped.tick(4, kLargeForce);
  CHECK(force_of("").isZero(0.0));
  CHECK_FALSE(stepped.device.state().ready);
  CHECK_FALSE(stepped.device.state().failed);
  CHECK_THAT(stepped.device.trouble(),
             ContainsSubstring("for a moment") && ContainsSubstring("HD_EXCEEDED_MAX"));
  for (int tick = 5; tick < kPauseTicks; ++tick) {
    stepped.tick(1, kLargeForce);
    REQUIRE(force_of("").isZero(0.0));
  }
  double rise = 0.0;
  for (int tick = 0; tick < 600; ++tick) {
    const double before = force_of("").norm();
    stepped.tick(1, kLargeForce);
    rise = std::max(rise, force_of("").norm() - before);
  }
  CHECK(rise < 1.001 * kLargeForce.norm() / 500);  // over 0.5 s
  CHECK(force_of("").isApprox(kLargeForce));
  CHECK(stepped.device.trouble().empty());
  CHECK(stepped.loop.counts().faults == 0);
}

TEST_CASE("the third warning within ten seconds takes the force for good, and is told") {
  const FakeSession session;
  SteppedLoop stepped;
  stepped.engage(kLargeForce);
  for (int k = 0; k < 2; ++k) {
    fakehd_raise_at_end("", 0x0203);
    come_back(stepped);
  }
  fakehd_raise_at_end("", 0x0201);
  stepped.tick(5, kLargeForce);
  CHECK(stepped.device.state().failed);
  CHECK_FALSE(stepped.device.state().lost);
  CHECK_THAT(stepped.device.trouble(), ContainsSubstring("no force any more") &&
                                           ContainsSubstring("HD_EXCEEDED_MAX_FORCE 0x0201") &&
                                           ContainsSubstring("start irdm-bridge again"));
  for (int tick = 0; tick < 2000; ++tick) {
    stepped.tick(1, kLargeForce);
    REQUIRE(force_of("").isZero(0.0));
  }
  CHECK(stepped.loop.filter().state() == FilterState::kFault);
  // It goes on being read.
  fakehd_place("", 1, 2, 3);
  stepped.tick(1, kLargeForce);
  CHECK(stepped.loop.reading().isApprox(Vector3(0.001, 0.002, 0.003)));
}

TEST_CASE("warnings that are seldom never take the force for good") {
  const FakeSession session;
  SteppedLoop stepped;
  stepped.engage(kLargeForce);
  for (int k = 0; k < 6; ++k) {
    fakehd_raise_at_end("", 0x0202);
    come_back(stepped);
    stepped.tick(kOftenTicks / 2,
                 Vector3::Zero());  // motors cool
    stepped.tick(100, kLargeForce);
  }
  CHECK_FALSE(stepped.device.state().failed);
}

TEST_CASE("fast waves in free air pause the force, and never take it for good") {
  const FakeSession session;
  SteppedLoop stepped;
  stepped.engage(kLargeForce);
  stepped.tick(100, Vector3::Zero());
  for (int wave = 0; wave < 5; ++wave) {
    wave % 2 == 0 ? fakehd_raise_at_begin("", 0x0203) : fakehd_raise_at_end("", 0x0203);
    stepped.tick(2, Vector3::Zero());
    CHECK_FALSE(stepped.device.state().ready);
    stepped.tick(kPauseTicks, Vector3::Zero());
    CHECK(stepped.device.state().ready);
  }
  CHECK_FALSE(stepped.device.state().failed);
  come_back(stepped);
}

TEST_CASE("a pause takes the same time at 500 Hz, and so does a look at the calibration") {
  const FakeSession session;
  SteppedDevice stepped("", 500.0);
  stepped.wanted = kLargeForce;
  stepped.tick(10);
  fakehd_raise_at_end("", 0x0203);
  const unsigned long looks = fakehd_calibration_checks("");
  stepped.tick(kPauseTicks / 2 - 1);
  CHECK_FALSE(stepped.device.state().ready);
  stepped.tick(2);
  CHECK(stepped.device.state().ready);
  CHECK(fakehd_calibration_checks("") - looks == 2);
}
