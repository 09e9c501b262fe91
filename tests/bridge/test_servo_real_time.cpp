#include <spdlog/spdlog.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <mutex>
#include <sstream>
#include <stdexcept>
#include <tuple>

#include "device_bridge/blackbox/tick_log.hpp"
#include "device_bridge/servo_link.hpp"
#include "device_bridge/servo_loop.hpp"
#include "device_bridge/virtual_stylus.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/left_out.hpp"
#include "tests/support/real_time_guard.hpp"

using namespace irdm;
using namespace irdm::test;
using Catch::Matchers::ContainsSubstring;

namespace {

/// A fixed wall at y = 0 that gives way by 1 mm per newton.
ContactModel wall() {
  ContactModel model;
  model.valid = true;
  model.dt = 0.002;
  model.horizon = 25;
  model.body = {1.0, Matrix3::Identity(), Support::kFixed};
  model.normal = Vector3(0, 1, 0);
  model.response[0] = 1e-3 * Matrix3::Identity();
  return model;
}

/// A second of pressing by 2 mm and leaving, again and again: by time of a session of any length.
VirtualStylus pressing() {
  std::istringstream text("time,x,y,z,button\n0,0,0.002,0,0\n0.4,0,-0.002,0,0\n0.8,0,0.002,0,0\n");
  return VirtualStylus(StylusScript::parse(text, "motion.csv"),
                       HandParameters{.turn = TurnParameters{}});
}

template <typename Action>
std::string violations_of(const Action& action) {
  const RealTimeGuard guard;
  action();
  return guard.violations();
}

}  // namespace

TEST_CASE("the guard of real-time steps sees what they must not do") {
  if (!AllocationGuard::active()) return leave_out(kNotCounted);
  CHECK(violations_of([] {}).empty());
  int* number = nullptr;
  CHECK_THAT(violations_of([&] { number = new int(3); }), ContainsSubstring("1 allocations"));
  CHECK(violations_of([&] { delete number; }) == "1 frees ");
  std::mutex mutex;
  CHECK(violations_of([&] { const std::lock_guard lock(mutex); }) == "1 locks ");
  CHECK_THAT(violations_of([] {
               try {
                 throw std::runtime_error("this");
               } catch (const std::runtime_error&) {
               }
             }),
             ContainsSubstring("1 throws"));
  CHECK_THAT(violations_of([] { std::ifstream file("/dev/null"); }),
             ContainsSubstring("allocations"));
  CHECK_THAT(violations_of([] { std::ignore = ::write(-1, "", 0); }),
             ContainsSubstring("1 file accesses"));
  CHECK_THAT(violations_of([] { spdlog::info("a line of the log"); }),
             ContainsSubstring("file accesses") || ContainsSubstring("locks"));
}

TEST_CASE("a million servo ticks touch neither heap, locks, exceptions nor files", "[slow]") {
  if (!AllocationGuard::active()) return leave_out(kNotCounted);
  const bool predicts = GENERATE(true, false);
  VirtualStylus device = pressing();
  ServoLoop loop(device, {.max_torque = 0.15});
  ServoLink link(1);
  TickLog log;
  ContactModel model = wall();
  REQUIRE(check(model) == ContactModelFault::kNone);
  std::int64_t ticks_in_contact = 0;
  std::uint64_t told = 0;
  const RealTimeGuard guard;
  for (int tick = 0; tick < 1'000'000; ++tick) {
    const std::int64_t now_ns = 1'000'000LL * tick;
    if (tick % 1000 == 0) {  // a session of one second, the last 20 ms of it without a link
      loop.restart();
      if (predicts) loop.predict(model.dt, 1'000'000);
    }
    loop.read(1e-3 * (tick % 1000));
    link.styluses[0].sample.put(loop.take_sample(now_ns));
    if (predicts && tick % 2 == 0) {
      model.step = model.newest = static_cast<std::uint64_t>(tick / 2);
      loop.receive(model, now_ns);
    }
    loop.end_steps(now_ns);
    const double depth = -loop.sample().tip.y();
    link.styluses[0].input.put(
        {.linked = tick % 1000 < 980,
         .any_force = true,
         .force = {.sample_time_ns = now_ns,
                   .contact = depth > 0 ? ContactState::kTouching : ContactState::kFree,
                   .force = Vector3(0, std::max(0.0, 400.0 * depth), 0),
                   .torque = Vector3(0, 0, std::max(0.0, 20.0 * depth))}});
    link.styluses[0].input.receive();
    loop.apply(now_ns, link.styluses[0].input.front());
    told += loop.applied() != nullptr ? 1 : 0;
    TickRow row;
    row.demand = loop.demanded();
    row.force = loop.shown();
    log.put(row);  // a full queue is no excuse either
    if (!loop.shown().isZero(0.0)) ++ticks_in_contact;
  }
  const std::string violations = guard.violations();
  INFO(violations);
  CHECK(violations.empty());
  CHECK(ticks_in_contact > 100'000);
  CHECK((told > 0) == predicts);
  CHECK(loop.demanded().solved_here == predicts);
}
