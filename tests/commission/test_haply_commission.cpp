#include <chrono>
#include <sstream>
#include <string>
#include <thread>
#include <utility>

#include "device_bridge/commission/commission.hpp"
#include "device_bridge/commission/obedient_hand.hpp"
#include "device_bridge/haply/haply_device.hpp"
#include "tests/commission/held_device.hpp"
#include "tests/commission/played_plan.hpp"
#include "tests/haply/fake_service.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;
using namespace irdm::commission;
using namespace irdm::test;

namespace {

/// In the service's axes.
Vector3 to_service(const Vector3& v) {
  return {v.x(), -v.z(), v.y()};
}

void place(const FakeService& service, const Vector3& tip) {
  const Vector3 at = to_service(tip) + Vector3(0.0, -0.12, 0.15);  // where the fake begins
  std::ostringstream order;
  order.precision(17);
  order << "place 049D " << at.x() << ' ' << at.y() << ' ' << at.z();
  service.order(order.str());
}

std::string keys(std::uint32_t buttons) {
  std::string letters;
  for (int bit = 0; bit < 3; ++bit) {
    if ((buttons >> bit & 1u) != 0) letters += "abc"[bit];
  }
  return letters.empty() ? "release" : "press " + letters;
}

/// The device in a hand that feels what is shown, a tick of 1 ms at a time: the next one begins
/// when the service has been told the force, and has told where the hand is then.
class HeldHaply final : public HaplyDevice {
 public:
  explicit HeldHaply(const FakeService& service)
      : HaplyDevice(service.settings()), service_(service) {}

  StylusPose read(double time) noexcept override {
    StylusPose pose = HaplyDevice::read(time);
    for (int looks = 0; !seen(pose); ++looks) {
      if (looks == kLooks) {
        ++unseen;
        return pose;
      }
      std::this_thread::sleep_for(std::chrono::microseconds(200));
      pose = HaplyDevice::read(time);
    }
    if (!shown_.isZero() && !unplugged_ && !told()) ++untold;
    return pose;
  }
  /// After the servo loop's tick.
  void move(ObedientHand& hand, VirtualSensor& sensor, const Vector3& shown) {
    before_ = std::exchange(shown_, shown);
    hand.advance(1e-3, shown);
    tip_ = sensor.measure(hand.tip());
    place(service_, tip_);
    const std::string pressed = keys(hand.buttons());
    if (std::exchange(pressed_, pressed) != pressed) service_.order(pressed);
    if (hand.unplugs()) service_.order("plugged 049D 0");
    unplugged_ = hand.unplugs();
  }

  int unseen = 0;  ///< ticks in which the hand was not told
  int untold = 0;  ///< ticks in which the force was not

 private:
  static constexpr int kLooks = 50'000;

  // The service tells where the hand is.
  bool seen(const StylusPose& pose) const {
    if (unplugged_) return !state().ready;
    return state().ready && !state().repeated && (pose.tip - kHome - tip_).norm() < 1e-9;
  }
  // It has been told the force; the one before where a message was on its way.
  bool told() const {
    const Vector3 force = service_.told().force;
    return force.isApprox(to_service(shown_), 1e-12) || force.isApprox(to_service(before_), 1e-12);
  }

  const FakeService& service_;
  const Vector3 kHome{0.0, 0.15, 0.12};
  Vector3 tip_ = Vector3::Zero();
  Vector3 shown_ = Vector3::Zero();
  Vector3 before_ = Vector3::Zero();
  std::string pressed_ = "release";
  bool unplugged_ = false;
};

/// Moves the fake service's device in real time, and goes before the step `last`.
class HaplyPerson final : public Person {
 public:
  HaplyPerson(const FakeService& service, std::string last)
      : service_(service), last_(std::move(last)) {}

  void tell(const std::string& line) override { told += line + '\n'; }
  bool begins(const Step& step) override {
    hand_.obey(step.request().order);
    return step.name() != last_;
  }
  bool confirms(const std::string&) override { return true; }
  bool stops(int timeout_ms) override {
    const auto end = Clock::now() + std::chrono::milliseconds(timeout_ms);
    while (Clock::now() < end) move();
    return false;
  }

  std::string told;

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr double kLongest = 0.005;  // a hand waits for a machine that has much to do [s]

  void move() {
    const Clock::time_point now = Clock::now();
    const Vector3 force = service_.told().force;
    const double elapsed = std::chrono::duration<double>(now - last_move_).count();
    hand_.advance(std::min(elapsed, kLongest), Vector3(force.x(), force.z(), -force.y()));
    last_move_ = now;
    place(service_, hand_.tip());
    service_.order(keys(hand_.buttons()));
    if (hand_.unplugs()) service_.order("plugged 049D 0");
  }

  const FakeService& service_;
  std::string last_;
  ObedientHand hand_;
  Clock::time_point last_move_ = Clock::now();
};

}  // namespace

TEST_CASE("commission: axes and buttons of the fake of Haply are right, led by the shell") {
  const FakeService service;
  HaplyDevice device(service.settings());
  BridgeConfig config;
  config.realtime = RealTimeScheduling::kIgnore;
  config.devices.push_back({.type = "haply",
                            .service = ServerAddress{"127.0.0.1", service.port()},
                            .realtime = RealTimeScheduling::kIgnore});
  HaplyPerson person(service, "rest noise");
  const Report report = irdm::commission::commission(config, device, person, {});
  INFO(to_text(report));
  CHECK(report.device == "inverse3, 049D");
  REQUIRE(report.steps.size() == 18);
  for (std::size_t i = 0; i < 7; ++i) {
    CAPTURE(i);
    CHECK(report.steps[i].verdict == Verdict::kPassed);
  }
  CHECK(report.steps[7].step == "rest noise");
  CHECK(report.steps[7].verdict == Verdict::kStopped);
  CHECK(report.steps.back().verdict == Verdict::kNotReached);
  CHECK_FALSE(report.signed_off());
  CHECK(service.told().largest == 0.0);
}

TEST_CASE("commission: the fake of Haply passes all steps, and its report is the example",
          "[exhaustive]") {
  const FakeService service;
  HeldHaply device(service);
  device.open();
  HeldDevice held(device);
  Report report = play_plan(
      {}, held.runner(), [&](const Order& order) { held.hand.obey(order); },
      [&] {
        held.tick();
        device.move(held.hand, held.sensor, held.shown());
      });
  report.type = "haply";
  report.device = device.identity();
  INFO(to_text(report));
  CHECK(report.signed_off());
  CHECK(report.device == "inverse3, 049D");
  CHECK(device.unseen == 0);
  CHECK(device.untold == 0);
  check_example(report, "commission-haply.toml");
}
