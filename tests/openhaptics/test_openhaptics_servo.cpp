#include <limits>
#include <memory>
#include <vector>

#include "common/realtime/clock.hpp"
#include "device_bridge/servo_thread.hpp"
#include "tests/openhaptics/fake_session.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/eventually.hpp"

using namespace irdm;
using namespace irdm::test;

namespace {

constexpr double kForever = std::numeric_limits<double>::infinity();

/// The servo loops of some devices on the fake driver; the test is the network.
class Rig {
 public:
  explicit Rig(const std::vector<const char*>& names)
      : scheduler_(std::make_shared<OpenHapticsScheduler>(FakeSession::api())),
        link(names.size()),
        samples(names.size()) {
    for (const char* name : names) {
      if (*name != '\0') fakehd_add(name);
      devices_.push_back(std::make_unique<OpenHapticsDevice>(name, scheduler_));
      devices_.back()->open();
      loops.emplace_back(*devices_.back(), FilterLimits{});
    }
    servo = std::make_unique<ServoThread>(link, loops, ServoSettings{.duration = kForever}, done);
  }
  ~Rig() {
    servo->stop();
    for (auto& device : devices_) device->close();
  }

  void begin_session() { link.state.put({.linked = true, .sessions = 1, .dt = 0.002}); }
  /// Answers the newest sample of each stylus with this force.
  void answer(const Vector3& force_W) {
    for (std::size_t i = 0; i < link.styluses.size(); ++i) {
      if (!link.styluses[i].sample.receive()) continue;
      samples[i] = link.styluses[i].sample.front();
      link.styluses[i].input.put(
          {.linked = true,
           .any_force = true,
           .force = {.sample_time_ns = samples[i].time_ns, .force = force_W}});
    }
  }

 private:
  std::shared_ptr<OpenHapticsScheduler> scheduler_;
  std::vector<std::unique_ptr<OpenHapticsDevice>> devices_;

 public:
  ServoLink link;
  std::vector<ServoLoop> loops;
  std::vector<StylusSample> samples;
  EventFd done;
  std::unique_ptr<ServoThread> servo;
};

/// Answers samples until the device is asked for more than `newton`.
bool feels(Rig& rig, const char* name, const Vector3& force, double newton) {
  return eventually([&] {
    rig.answer(force);
    return force_of(name).norm() > newton;
  });
}

const Vector3 kPush(0, 2, 0);

}  // namespace

TEST_CASE("the servo loop runs in the driver's tick, with a frame in each, before a session too") {
  const FakeSession session;
  fakehd_drive_by_hand();
  fakehd_place("", 10, 20, 30);
  Rig rig({""});
  rig.servo->start();
  CHECK(rig.servo->scheduling() == "the driver's own");
  fakehd_tick(5);
  CHECK(fakehd_frames("") == 5);
  CHECK_FALSE(rig.link.styluses[0].sample.receive());
  rig.begin_session();
  fakehd_tick(1);
  REQUIRE(rig.link.styluses[0].sample.receive());
  CHECK(rig.link.styluses[0].sample.front().tip.isApprox(Vector3(0.01, 0.02, 0.03)));
  CHECK(rig.link.styluses[0].sample.front().sequence == 0);
  CHECK(eventually([&] {
    fakehd_tick(1);
    rig.answer(kPush);
    return force_of("").isApprox(kPush);
  }));
  CHECK(fakehd_frames("") == fakehd_ticks());
}

TEST_CASE("two devices of the driver are served in the same tick") {
  const FakeSession session;
  fakehd_drive_by_hand();
  Rig rig({"Left", "Right"});
  rig.servo->start();
  rig.begin_session();
  CHECK(eventually([&] {
    fakehd_tick(1);
    rig.answer(kPush);
    return force_of("Left").isApprox(kPush) && force_of("Right").isApprox(kPush);
  }));
  CHECK(rig.samples[0].time_ns == rig.samples[1].time_ns);
  CHECK(fakehd_frames("Left") == fakehd_ticks());
  CHECK(fakehd_frames("Right") == fakehd_ticks());
}

TEST_CASE("a device that is unplugged in contact has no force, and the servo loop ends") {
  const FakeSession session;
  Rig rig({"Left", "Right"});
  rig.servo->start();
  rig.begin_session();
  REQUIRE(feels(rig, "Left", kPush, 1.9));
  fakehd_unplug("Left");
  REQUIRE(rig.done.wait(kDeadlineMs));
  CHECK(force_of("Left").isZero(0.0));
  CHECK(force_of("Right").isZero(0.0));
  rig.servo->stop();
  CHECK(rig.servo->report().end == ServoEnd::kDeviceLost);
  CHECK(rig.loops[0].counts().faults == 1);
  CHECK(rig.loops[1].counts().faults == 0);
}

TEST_CASE("a device that is unplugged before a session ends the servo loop") {
  const FakeSession session;
  Rig rig({""});
  rig.servo->start();
  fakehd_unplug("");
  REQUIRE(rig.done.wait(kDeadlineMs));
  rig.servo->stop();
  CHECK(rig.servo->report().end == ServoEnd::kDeviceLost);
}

TEST_CASE("a device that failed has no force any more, but goes on being read") {
  const FakeSession session;
  Rig rig({""});
  rig.servo->start();
  rig.begin_session();
  REQUIRE(feels(rig, "", kPush, 1.9));
  fakehd_raise_at_end("", 0x0304);
  REQUIRE(eventually([&] {
    rig.answer(kPush);
    return force_of("").isZero(0.0);
  }));
  fakehd_place("", 1, 2, 3);
  const std::uint64_t before = rig.samples[0].sequence;
  REQUIRE(eventually([&] {
    rig.answer(kPush);
    return rig.samples[0].sequence > before + 100;
  }));
  CHECK(force_of("").isZero(0.0));
  CHECK(rig.samples[0].tip.isApprox(Vector3(0.001, 0.002, 0.003)));
  rig.servo->stop();
  CHECK(rig.servo->report().end == ServoEnd::kStopped);
  CHECK(rig.loops[0].counts().faults == 1);
}

TEST_CASE("a servo loop in the driver's ticks fades its force when it is stopped") {
  const FakeSession session;
  Rig rig({""});
  rig.servo->start();
  rig.begin_session();
  REQUIRE(feels(rig, "", kPush, 1.9));
  rig.servo->stop();
  CHECK(rig.servo->report().end == ServoEnd::kStopped);
  CHECK(rig.servo->report().ticks > 0);
  CHECK(force_of("").isZero(0.0));
}

TEST_CASE("a driver that makes no ticks any more is noticed") {
  const FakeSession session;
  Rig rig({""});
  rig.servo->start();
  rig.begin_session();
  REQUIRE(feels(rig, "", kPush, 1.0));
  fakehd_hang();
  constexpr std::int64_t kSecondNs = 1'000'000'000;
  CHECK(rig.servo->driver_silent(monotonic_ns() + 2 * kSecondNs));
  rig.servo->stop();
  CHECK(rig.servo->report().end == ServoEnd::kDriverStuck);
}

TEST_CASE("a device that loses its calibration gets its force back slowly") {
  const FakeSession session;
  Rig rig({""});
  rig.servo->start();
  rig.begin_session();
  REQUIRE(feels(rig, "", kPush, 1.9));
  fakehd_calibration("", 0x5002, 4);
  REQUIRE(eventually([&] {
    rig.answer(kPush);
    return rig.loops[0].device_state().ready == false && force_of("").isZero(0.0);
  }));
  fakehd_calibration("", 0x5000, 4);
  CHECK(feels(rig, "", kPush, 1.9));
  rig.servo->stop();
  CHECK(rig.loops[0].counts().faults == 0);
}

TEST_CASE("a servo loop refuses two drivers that both want to make its ticks") {
  const FakeSession session;
  const auto one = std::make_shared<OpenHapticsScheduler>(FakeSession::api());
  const auto other = std::make_shared<OpenHapticsScheduler>(FakeSession::api());
  OpenHapticsDevice left("Left", one);
  OpenHapticsDevice right("Right", other);
  std::vector<ServoLoop> loops;
  loops.emplace_back(left, FilterLimits{});
  loops.emplace_back(right, FilterLimits{});
  ServoLink link(2);
  EventFd done;
  ServoThread servo(link, loops, {}, done);
  CHECK_THROWS_WITH(servo.start(), Catch::Matchers::ContainsSubstring("two drivers"));
}
