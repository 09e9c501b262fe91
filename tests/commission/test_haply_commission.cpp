#include <catch2/catch.hpp>
#include <chrono>
#include <sstream>

#include "device_bridge/commission/commission.hpp"
#include "device_bridge/commission/obedient_hand.hpp"
#include "device_bridge/haply/haply_device.hpp"
#include "tests/haply/fake_service.hpp"

using namespace irdm;
using namespace irdm::commission;
using namespace irdm::test;

namespace {

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

  // The service's axes are ours as (x, -z, y). The handle begins where the fake has it.
  void move() {
    const Clock::time_point now = Clock::now();
    const Vector3 force = service_.told().force;
    const double elapsed = std::chrono::duration<double>(now - last_move_).count();
    hand_.advance(std::min(elapsed, kLongest), Vector3(force.x(), force.z(), -force.y()));
    last_move_ = now;
    const Vector3& tip = hand_.tip();
    std::ostringstream place;
    place << "place 049D " << tip.x() << ' ' << -0.12 - tip.z() << ' ' << 0.15 + tip.y();
    service_.order(place.str());
    std::string keys;
    for (int bit = 0; bit < 3; ++bit) {
      if ((hand_.buttons() >> bit & 1u) != 0) keys += "abc"[bit];
    }
    service_.order(keys.empty() ? "release" : "press " + keys);
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
  const Report report = irdm::commission::commission(config, device, person);
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
