#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>
#include <string>

#include "common/motion/rigid_body.hpp"
#include "device_bridge/safety/safety_filter.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;

namespace {

constexpr double kRise = 300.0;
constexpr double kFall = 1200.0;
constexpr double kTorqueRise = 15.0;
constexpr double kTorqueFall = 60.0;

/// What a kind of device bears.
struct DeviceKind {
  const char* name;
  double force;   ///< [N]
  double torque;  ///< [N m]
};
constexpr DeviceKind kTypical{"with torque", 3.3, 0.15};
// As their drivers or public tables say.
constexpr std::array kDevices{DeviceKind{"Touch", 3.3, 0.0}, DeviceKind{"Premium 3.0", 22.0, 0.0},
                              DeviceKind{"Falcon", 8.0, 0.0}, DeviceKind{"sigma.7", 12.0, 0.2}};

/// Everything that can go wrong with what the filter is told, mixed with stretches in which all is
/// well, so that it gets to show large forces.
class Hostility {
 public:
  Hostility(std::uint64_t seed, const DeviceKind& device) : random_(seed), device_(device) {}

  std::int64_t now_ns = 0;
  DeviceReading reading;
  ForceDemand demand;

  void next(SafetyFilter& filter) {
    if (one_in(2000)) calm_ = !calm_;
    now_ns = one_in(calm_ ? 100'000 : 300) ? wild_time() : step_time();
    move();
    if (one_in(calm_ ? 20 : 3)) {
      demand_something();
    } else if (calm_) {
      demand.sample_time_ns = now_ns;  // large forces take a while to rise
    }
    demand.linked = !one_in(calm_ ? 5000 : 50);
    reading.motor_temperature = one_in(50) ? wild() : 0.0;
    reading.repeated = one_in(20);
    reading.saturated = one_in(10);
    reading.off = one_in(calm_ ? 20'000 : 300);
    if (one_in(calm_ ? 50'000 : 2000)) filter.fail();
    if (one_in(5000)) filter.disarm();
    if (one_in(100)) act(filter);
  }

 private:
  bool one_in(std::uint32_t n) { return random_() % n == 0; }
  double uniform(double least, double most) {
    return least + (most - least) * static_cast<double>(random_() >> 11) * 0x1p-53;
  }
  double wild() {
    switch (random_() % 8) {
      case 0:
        return std::numeric_limits<double>::quiet_NaN();
      case 1:
        return std::numeric_limits<double>::infinity();
      case 2:
        return -std::numeric_limits<double>::infinity();
      case 3:
        return 1e308;
      case 4:
        return 5e-324;
      case 5:
        return 0.0;
      default:
        return uniform(-1e3, 1e3);
    }
  }
  Vector3 wild_vector() { return {wild(), wild(), wild()}; }
  Vector3 vector(double most) {
    return {uniform(-most, most), uniform(-most, most), uniform(-most, most)};
  }
  std::int64_t step_time() {
    const auto step = static_cast<std::int64_t>(calm_ ? 1'000'000 : random_() % 3'000'000);
    constexpr std::int64_t kFar = std::numeric_limits<std::int64_t>::max() / 2;
    return now_ns > kFar ? 0 : now_ns + step;
  }
  std::int64_t wild_time() {
    switch (random_() % 5) {
      case 0:
        return std::numeric_limits<std::int64_t>::max();
      case 1:
        return std::numeric_limits<std::int64_t>::min();
      case 2:
        return now_ns;
      default:
        return static_cast<std::int64_t>(random_());
    }
  }
  void move() {
    if (!calm_ && one_in(100)) reading.tip = wild_vector();
    if (!reading.tip.allFinite() || reading.tip.norm() > 1.0) reading.tip.setZero();
    reading.tip += vector(calm_ ? 3e-4 : 2e-3);
    if (!calm_ && one_in(50)) reading.tip = wild_vector();
    turn();
  }
  void turn() {
    Quaternion& at = reading.orientation;
    if (!(std::abs(at.norm() - 1.0) < 1e-3)) at.setIdentity();
    at = (rotation_from_vector(vector(calm_ ? 6e-3 : 4e-2)) * at).normalized();
    if (!calm_ && one_in(50)) at.coeffs() << wild(), wild(), wild(), wild();
  }
  void demand_something() {
    demand.any = !one_in(50);
    demand.sample_time_ns = one_in(calm_ ? 1000 : 5) ? wild_time() : now_ns;
    demand.horizon_ns = one_in(5) ? wild_time() : ForceDemand::kHoldHorizonNs;
    demand.contact = static_cast<ContactState>(random_() % 3);
    demand.force =
        one_in(calm_ ? 100 : 5) ? wild_vector() : vector(device_.force * (one_in(3) ? 2.4 : 0.3));
    demand.torque =
        one_in(calm_ ? 100 : 5) ? wild_vector() : vector(most_torque() * (one_in(3) ? 2.7 : 0.3));
    demand.normal = one_in(10) ? wild_vector() : vector(1.0).normalized();
  }
  void act(SafetyFilter& filter) {
    if (filter.state() == FilterState::kFault) filter.disarm();
    filter.arm();
  }

  // Where it renders none, it is asked for all the same.
  double most_torque() const { return device_.torque > 0.0 ? device_.torque : kTypical.torque; }

  std::mt19937_64 random_;
  DeviceKind device_;
  bool calm_ = false;
};

/// Of a force [N] or a torque [N m].
struct Extremes {
  bool finite = true;
  double most = 0.0;
  double rise = 0.0;    ///< of the magnitude, beyond what the time since the last tick allows
  double change = 0.0;  ///< the same of any change

  void look(const Vector3& before, const Vector3& now, double rise_allowed, double change_allowed) {
    finite = finite && now.allFinite();
    most = std::max(most, now.norm());
    rise = std::max(rise, now.norm() - before.norm() - rise_allowed);
    change = std::max(change, (now - before).norm() - change_allowed);
  }
};

struct Outcome {
  Extremes force;
  Extremes torque;
  std::uint64_t engaged = 0;
  std::uint64_t off = 0;       ///< ticks with motors that were
  std::uint64_t sent_off = 0;  ///< of these, with a force all the same
};

// What counts of the time between two ticks [s].
double since(std::int64_t earlier, std::int64_t later) {
  if (later <= earlier) return 0.0;
  const std::uint64_t way = static_cast<std::uint64_t>(later) - static_cast<std::uint64_t>(earlier);
  return 1e-9 * static_cast<double>(std::min(way, std::uint64_t{2'000'000}));
}

Outcome run(const DeviceKind& device, std::uint64_t seed, int ticks, Guards guards) {
  SafetyFilter filter({.max_force = device.force,
                       .continuous_force = 0.27 * device.force,
                       .max_torque = device.torque,
                       .continuous_torque = 0.33 * std::max(device.torque, kTypical.torque)},
                      guards);
  Hostility hostility(seed, device);
  Outcome outcome;
  Wrench before;
  std::int64_t before_ns = 0;
  for (int i = 0; i < ticks; ++i) {
    hostility.next(filter);
    const Wrench shown = filter.step(hostility.now_ns, hostility.reading, hostility.demand);
    const double elapsed = since(before_ns, hostility.now_ns);
    if (hostility.reading.off) {
      ++outcome.off;
      outcome.sent_off += shown.is_zero() ? 0 : 1;
      before = Wrench{};
    }
    outcome.force.look(before.force, shown.force, kRise * elapsed, kFall * elapsed);
    outcome.torque.look(before.torque, shown.torque, kTorqueRise * elapsed, kTorqueFall * elapsed);
    outcome.engaged += filter.state() == FilterState::kEngaged ? 1 : 0;
    before = shown;
    before_ns = hostility.now_ns;
  }
  return outcome;
}

void check_limits(const Extremes& extremes, double most) {
  CHECK(extremes.finite);
  CHECK(extremes.most <= most * (1.0 + 1e-12));
  CHECK(extremes.rise <= 1e-12);
  CHECK(extremes.change <= 1e-12);
}

Outcome check(const DeviceKind& device, std::uint64_t seed, int ticks, Guards guards = {}) {
  CAPTURE(device.name, seed);
  const Outcome outcome = run(device, seed, ticks, guards);
  check_limits(outcome.force, device.force);
  check_limits(outcome.torque, device.torque);
  CHECK(outcome.off > 0);
  CHECK(outcome.sent_off == 0);
  CHECK(outcome.engaged > static_cast<std::uint64_t>(ticks) / 10);
  return outcome;
}

// Hostile forces shake the hand, so that hardly any is shown in full with all guards.
void check_up_to_the_limits(const DeviceKind& device, std::uint64_t seed, int ticks) {
  const Outcome most = check(device, seed, ticks, Guards{}.without(Guard::kOscillation));
  CHECK(most.force.most > 0.99 * device.force);
  CHECK(most.torque.most >= 0.99 * device.torque);
}

}  // namespace

TEST_CASE("safety filter: nothing that comes in gets a force out that is beyond the limits") {
  for (const std::uint64_t seed : {1u, 2u}) check(kTypical, seed, 300'000);
  check_up_to_the_limits(kTypical, 3, 300'000);
}

TEST_CASE("safety filter: the same with the limits of each kind of device") {
  for (const DeviceKind& device : kDevices) check_up_to_the_limits(device, 4, 200'000);
}

TEST_CASE("safety filter: the same for a hundred million ticks", "[exhaustive]") {
  for (std::uint64_t seed = 10; seed < 20; ++seed) check(kTypical, seed, 10'000'000);
  check_up_to_the_limits(kTypical, 20, 10'000'000);
}

// IRDM_HOSTILE_TICKS=10000000: a hundred million in all, for each device, in some three minutes.
TEST_CASE("safety filter: ten million ticks with the limits of each kind of device",
          "[exhaustive]") {
  const char* const wanted = std::getenv("IRDM_HOSTILE_TICKS");
  const int ticks = wanted != nullptr ? std::stoi(wanted) : 1'000'000;
  const DeviceKind device = GENERATE(from_range(kDevices));
  for (std::uint64_t seed = 30; seed < 39; ++seed) check(device, seed, ticks);
  check_up_to_the_limits(device, 39, ticks);
}
