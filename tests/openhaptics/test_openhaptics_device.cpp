#include <array>
#include <cmath>
#include <string>

#include "common/error.hpp"
#include "tests/openhaptics/fake_session.hpp"
#include "tests/support/allocation_guard.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/left_out.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::test;

TEST_CASE("a device of OpenHaptics is opened with its limits on and closed with its force off") {
  const FakeSession session;
  fakehd_rate_force("", 7.9, 1.75);
  {
    SteppedDevice stepped;
    for (const unsigned capability : {0x4000u, 0x4001u, 0x4003u, 0x2606u, 0x2607u}) {
      CHECK(fakehd_is_on("", capability) == 1);
    }
    CHECK(stepped.device.rating().peak == 7.9);
    CHECK(stepped.device.rating().continuous == 1.75);
    CHECK_FALSE(stepped.device.simulated());
    CHECK(stepped.device.trouble().empty());
  }
  CHECK(fakehd_is_open("") == 0);
  CHECK(fakehd_is_on("", 0x4000) == 0);
}

TEST_CASE("a rating that makes no sense is none") {
  const FakeSession session;
  fakehd_rate_force("", 0.0, std::nan(""));
  const SteppedDevice stepped;
  CHECK(std::isinf(stepped.device.rating().peak));
  CHECK(std::isinf(stepped.device.rating().continuous));
}

TEST_CASE("a reading is taken from mm to m, and from columns to a rotation") {
  const FakeSession session;
  SteppedDevice stepped;
  // Turned by 90 degrees about z: x goes to y.
  const std::array<double, 16> turned{0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 12, -34, 56, 1};
  fakehd_transform("", turned.data());
  fakehd_press("", 0x105);
  const StylusPose& pose = stepped.tick();
  CHECK(pose.tip.isApprox(Vector3(0.012, -0.034, 0.056)));
  CHECK((pose.orientation * Vector3::UnitX()).isApprox(Vector3::UnitY()));
  CHECK(pose.buttons == 5);
}

TEST_CASE("a transform that holds no rotation is a reading of no use") {
  const FakeSession session;
  SteppedDevice stepped;
  const std::array<double, 16> nothing{};
  fakehd_transform("", nothing.data());
  CHECK(stepped.tick().tip.hasNaN());
}

TEST_CASE("a force goes out in the frame of its reading, one frame a tick") {
  const FakeSession session;
  SteppedDevice stepped;
  for (int tick = 1; tick <= 20; ++tick) {
    stepped.wanted = Vector3(0.1 * tick, -0.05 * tick, 0.02 * tick);
    stepped.tick();
    CHECK(force_of("") == stepped.wanted);
    CHECK(fakehd_frames("") == static_cast<unsigned long>(tick));
  }
  stepped.wanted = Vector3(0, std::nan(""), 0);
  stepped.tick();
  CHECK(force_of("").isZero(0.0));
}

TEST_CASE("errors of the driver change a device's state, at the begin of a frame and at its end") {
  struct Case {
    unsigned code;
    bool failed;
    bool lost;
  };
  const bool at_begin = GENERATE(true, false);
  const auto [code, failed, lost] =
      GENERATE(Case{0x0204, true, false}, Case{0x0300, true, true}, Case{0x0302, true, true},
               Case{0x0304, true, false}, Case{0x0402, false, false}, Case{0x0100, false, false},
               Case{0x0200, false, false}, Case{0x0999, true, false});
  INFO("code " << code);
  const FakeSession session;
  SteppedDevice stepped;
  CHECK_FALSE(stepped.tick().tip.hasNaN());
  at_begin ? fakehd_raise_at_begin("", code) : fakehd_raise_at_end("", code);
  stepped.tick();
  CHECK(stepped.device.state().failed == failed);
  CHECK(stepped.device.state().lost == lost);
  // For good.
  stepped.tick(10);
  CHECK(stepped.device.state().failed == failed);
  CHECK(stepped.device.trouble().empty() == !failed);
}

TEST_CASE("a frame that went wrong spoils one reading") {
  const FakeSession session;
  SteppedDevice stepped;
  fakehd_raise_at_begin("", 0x0402);
  CHECK(stepped.tick().tip.hasNaN());
  CHECK_FALSE(stepped.tick().tip.hasNaN());
  fakehd_raise_at_end("", 0x0402);
  CHECK_FALSE(stepped.tick().tip.hasNaN());
  CHECK(stepped.tick().tip.hasNaN());
  CHECK_FALSE(stepped.tick().tip.hasNaN());
}

TEST_CASE("the first error that took the force is the one that is told") {
  const FakeSession session;
  SteppedDevice stepped("Default Device");
  fakehd_raise_at_end("", 0x0304);
  stepped.tick();
  fakehd_unplug("");
  stepped.tick(3);
  CHECK(stepped.device.state().lost);
  CHECK_THAT(stepped.device.trouble(), ContainsSubstring("'Default Device'") &&
                                           ContainsSubstring("HD_TIMER_ERROR") &&
                                           ContainsSubstring("run fewer programs"));
}

TEST_CASE("the warmest motor is told, and a warning of the driver counts for five seconds") {
  const FakeSession session;
  SteppedDevice stepped;
  fakehd_temperature("", 0.6);
  stepped.tick();
  CHECK(stepped.device.state().motor_temperature == 0.6);
  fakehd_raise_at_end("", 0x0200);
  stepped.tick(2);
  CHECK(stepped.device.state().motor_temperature == 1.0);
  CHECK_FALSE(stepped.device.state().failed);
  stepped.tick(4900);
  CHECK(stepped.device.state().motor_temperature == 1.0);
  stepped.tick(200);
  CHECK(stepped.device.state().motor_temperature == 0.6);
}

TEST_CASE("motors that heat up under a force are warm in the end") {
  const FakeSession session;
  fakehd_heating("", 500.0);
  SteppedDevice stepped;
  stepped.wanted = Vector3(0, 3.0, 0);
  stepped.tick(20);
  CHECK(stepped.device.state().motor_temperature > 0.1);
  CHECK(stepped.device.state().motor_temperature < 0.9);
  stepped.tick(500);
  CHECK(stepped.device.state().motor_temperature == 1.0);
}

TEST_CASE("a device that cannot tell its temperature gives good readings all the same") {
  const FakeSession session;
  fakehd_no_temperature("");
  SteppedDevice stepped;
  for (int tick = 0; tick < 5; ++tick) CHECK_FALSE(stepped.tick().tip.hasNaN());
  CHECK(stepped.device.state().motor_temperature == 0.0);
  CHECK_FALSE(stepped.device.state().failed);
}

TEST_CASE("two devices in one tick: each gets its own force and its own errors") {
  const FakeSession session;
  fakehd_add("Left");
  fakehd_add("Right");
  fakehd_drive_by_hand();
  const auto scheduler = std::make_shared<OpenHapticsScheduler>(FakeSession::api());
  OpenHapticsDevice left("Left", scheduler);
  OpenHapticsDevice right("Right", scheduler);
  left.open();
  right.open();
  scheduler->start(1000.0, [&] {
    left.read(0.0);
    left.write({Vector3(1, 0, 0)});
    right.read(0.0);
    right.write({Vector3(0, 2, 0)});
    return true;
  });
  fakehd_tick(1);
  CHECK(force_of("Left") == Vector3(1, 0, 0));
  CHECK(force_of("Right") == Vector3(0, 2, 0));
  fakehd_raise_at_end("Right", 0x0204);
  fakehd_tick(2);
  CHECK_FALSE(left.state().failed);
  CHECK(right.state().failed);
  CHECK(fakehd_frames("Left") == 3);
  CHECK(fakehd_frames("Right") == 3);
  // Each is asked for its own calibration, outside of the other's frame, too.
  fakehd_tick(hd::Calibration::kPeriodNs / kMs);
  CHECK(fakehd_calibration_checks("Left") == 2);
  CHECK(fakehd_calibration_checks("Right") == 2);
  // Errors wait for whoever asks first, and are still given to the device that they are about.
  FakeSession::api();
  fakehd_raise_at_end("Left", 0x0203);
  scheduler->stop();
  left.close();
  right.close();
}

TEST_CASE("a device that the driver refuses is not opened and says why") {
  const FakeSession session;
  const auto scheduler = std::make_shared<OpenHapticsScheduler>(FakeSession::api());
  OpenHapticsDevice unknown("Nobody", scheduler);
  CHECK_THROWS_WITH(unknown.open(), ContainsSubstring("device 'Nobody'"));
  OpenHapticsDevice first("", scheduler);
  first.open();
  OpenHapticsDevice second("Default Device", scheduler);
  CHECK_THROWS_WITH(second.open(), ContainsSubstring("in use"));
  first.close();
  fakehd_refuse(0x0600);
  CHECK_THROWS_WITH(first.open(), ContainsSubstring("HD_INVALID_LICENSE"));
}

TEST_CASE("a driver that starts its default device only: the way out is told, and works") {
  const FakeSession session;
  fakehd_add("Left");
  fakehd_refuse_names();
  const auto scheduler = std::make_shared<OpenHapticsScheduler>(FakeSession::api());
  OpenHapticsDevice named("Left", scheduler);
  CHECK_THROWS_WITH(named.open(), ContainsSubstring("device 'Left'"));
  OpenHapticsDevice nameless("", scheduler);
  CHECK_NOTHROW(nameless.open());
}

TEST_CASE("a rate that the driver does not run at is refused, but for the one that it has") {
  const FakeSession session;
  fakehd_drive_by_hand();
  const auto scheduler = std::make_shared<OpenHapticsScheduler>(FakeSession::api());
  OpenHapticsDevice device("", scheduler);
  device.open();
  const auto tick = [] { return true; };
  CHECK_THROWS_WITH(scheduler->start(750.0, tick),
                    ContainsSubstring("750 Hz") && ContainsSubstring("rate = 1000"));
  scheduler->start(500.0, tick);
  CHECK(fakehd_rate() == 500);
  scheduler->stop();
  fakehd_refuse_rates();
  CHECK_THROWS_AS(scheduler->start(500.0, tick), Error);
  CHECK_NOTHROW(scheduler->start(1000.0, tick));
  scheduler->stop();
  device.close();
}

TEST_CASE("a tick with a device of OpenHaptics allocates nothing of its own") {
  if (!AllocationGuard::active()) return leave_out(kNotCounted);
  static hd::Callback callback = nullptr;
  static void* data = nullptr;
  const hd::Api quiet{
      .init_device = [](const char*) { return hd::Handle{0}; },
      .disable_device = [](hd::Handle) {},
      .make_current_device = [](hd::Handle) {},
      .begin_frame = [](hd::Handle) {},
      .end_frame = [](hd::Handle) {},
      .get_error = [] { return hd::ErrorInfo{}; },
      .enable = [](hd::Name) {},
      .disable = [](hd::Name) {},
      .is_enabled = [](hd::Name) -> unsigned char { return 1; },
      .get_integerv = [](hd::Name, std::int32_t* value) { *value = 0; },
      .get_doublev = [](hd::Name, double* value) { *value = 0.0; },
      .get_string = [](hd::Name) -> const char* { return "quiet"; },
      .set_doublev = [](hd::Name, const double*) {},
      .check_calibration = [] { return hd::kCalibrationOk; },
      .update_calibration = [](hd::Name) {},
      .start_scheduler = [] {},
      .stop_scheduler = [] {},
      .set_scheduler_rate = [](unsigned long) {},
      .schedule_asynchronous =
          [](hd::Callback given, void* with, std::uint16_t) {
            callback = given;
            data = with;
            return hd::ScheduleHandle{1};
          },
      .unschedule = [](hd::ScheduleHandle) {},
  };
  const auto scheduler = std::make_shared<OpenHapticsScheduler>(quiet);
  OpenHapticsDevice device("", scheduler);
  device.open();
  int ticks = 0;
  scheduler->start(1000.0, [&] {
    device.read(0.0);
    device.write({Vector3(0, 1, 0)});
    if (ticks == 500) device.take({.code = 0x0203});
    return ++ticks < 1000;
  });
  const AllocationGuard guard;
  while (callback(data) == hd::kCallbackContinue) {
  }
  CHECK(guard.count() == 0);
  CHECK(ticks == 1000);
  scheduler->stop();
  device.close();
}
