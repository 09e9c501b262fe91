#include <algorithm>

#include "device_bridge/workspace.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;

TEST_CASE("clutch: the tip stays while the button is down, and jumps neither then nor afterwards") {
  Clutch clutch;
  CHECK(clutch.move(Vector3(0.01, 0, 0), false) == Vector3(0.01, 0, 0));
  const Vector3 held(0.02, 0, 0);
  CHECK(clutch.move(held, true) == held);
  CHECK(clutch.move(Vector3(-0.1, 0.2, 0.3), true) == held);
  CHECK(clutch.move(Vector3(-0.2, 0.1, 0.3), true) == held);
  // It goes on from there by as much as the device moves.
  CHECK(clutch.move(Vector3(-0.25, 0.1, 0.3), false) == held);
  CHECK(clutch.move(Vector3(-0.24, 0.1, 0.33), false).isApprox(held + Vector3(0.01, 0, 0.03)));
}

TEST_CASE("clutch: offsets add up over several uses") {
  Clutch clutch;
  double device = 0.0;
  for (int use = 0; use < 3; ++use) {
    for (int i = 0; i < 10; ++i) clutch.move(Vector3(device += 0.01, 0, 0), false);
    for (int i = 0; i < 10; ++i) clutch.move(Vector3(device -= 0.01, 0, 0), true);
    clutch.move(Vector3(device, 0, 0), false);
  }
  CHECK(device == Approx(0.0).margin(1e-12));
  // Each time 10 steps forwards, and one back: that of the reading in which the button goes down.
  CHECK(clutch.move(Vector3(device, 0, 0), false).x() == Approx(3 * 0.09).epsilon(1e-12));
}

TEST_CASE("clutch: the force fades out and in without a jump, also when pressed again meanwhile") {
  constexpr std::int64_t kTickNs = 1'000'000;
  constexpr double kLargest = 1.001 * static_cast<double>(kTickNs) / Clutch::kFadeNs;
  Clutch clutch;
  std::int64_t now_ns = 7'000'000'000;
  double last = clutch.gain(now_ns);
  CHECK(last == 1.0);
  const auto play = [&](bool down, int ticks) {
    for (int i = 0; i < ticks; ++i) {
      clutch.move(Vector3(0, 0, 0), down);
      const double gain = clutch.gain(now_ns += kTickNs);
      REQUIRE(std::abs(gain - last) <= kLargest);
      last = gain;
    }
    return last;
  };
  CHECK(play(false, 5) == 1.0);
  CHECK(play(true, 20) == Approx(0.6));
  CHECK(play(false, 10) == Approx(0.8));
  CHECK(play(true, 60) == 0.0);
  CHECK(play(false, 25) == Approx(0.5));
  CHECK(play(false, 60) == 1.0);
}

TEST_CASE("buttons of a device become those of the wire, and the clutch stays at the bridge") {
  const ButtonMap usual;
  CHECK(usual.to_wire(0) == 0);
  CHECK(usual.to_wire(1) == kGrabButton);
  CHECK(usual.to_wire(2) == 0);
  CHECK(usual.to_wire(4) == kResetButton);
  CHECK(usual.to_wire(0xFFFFFFFF) == (kGrabButton | kResetButton));
  CHECK(usual.clutched(2));
  CHECK_FALSE(usual.clutched(5));
  const ButtonMap other{.grab = 31, .clutch = ButtonMap::kNone, .reset = 0};
  CHECK(other.to_wire(0x80000000) == kGrabButton);
  CHECK(other.to_wire(1) == kResetButton);
  CHECK_FALSE(other.clutched(0xFFFFFFFF));
}
