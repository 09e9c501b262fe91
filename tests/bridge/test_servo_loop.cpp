#include <catch2/catch.hpp>
#include <limits>
#include <sstream>

#include "device_bridge/servo_link.hpp"
#include "device_bridge/servo_loop.hpp"
#include "device_bridge/virtual_stylus.hpp"
#include "tests/support/allocation_guard.hpp"

using namespace irdm;

namespace {

/// A device that shows what was done to it.
class ProbeDevice : public HapticDevice {
 public:
  void open() override {}
  void close() noexcept override {}
  StylusPose read(double) noexcept override { return pose; }
  void write(const Vector3& given) noexcept override { force = given; }
  bool simulated() const noexcept override { return true; }
  double duration() const noexcept override { return 1.0; }

  StylusPose pose;
  Vector3 force = Vector3::Constant(7.0);
};

}  // namespace

TEST_CASE("servo loop numbers its samples and stamps them") {
  ProbeDevice device;
  device.pose = {.tip = Vector3(1, 2, 3), .buttons = 1};
  ServoLoop loop(device, {});
  loop.read(0.0);
  CHECK(loop.take_sample(50).sequence == 0);
  const StylusSample sample = loop.take_sample(51);
  CHECK(sample.sequence == 1);
  CHECK(sample.time_ns == 51);
  CHECK(sample.tip == Vector3(1, 2, 3));
  CHECK(sample.buttons == 1);
  loop.restart();
  CHECK(loop.take_sample(52).sequence == 0);
}

TEST_CASE("servo loop keeps the last good reading of a device that fails") {
  ProbeDevice device;
  ServoLoop loop(device, {});
  device.pose.tip = Vector3(1, 2, 3);
  loop.read(0.0);
  device.pose.tip.x() = std::numeric_limits<double>::quiet_NaN();
  loop.read(0.0);
  CHECK(loop.take_sample(0).tip == Vector3(1, 2, 3));
  CHECK(loop.faults() == 1);
}

TEST_CASE("servo loop shows the guarded force and remembers the largest") {
  ProbeDevice device;
  ServoLoop loop(device, {.max_force = 2.0});
  ServoInput input{.linked = true, .any_force = true, .force = {.force = Vector3(0, 5, 0)}};
  loop.apply(0, input);
  CHECK(device.force.isApprox(Vector3(0, 2, 0)));
  loop.apply(1'000'000'000, input);
  CHECK(device.force == Vector3::Zero());
  CHECK(loop.peak_force() == Approx(2.0));
  loop.apply(0, input);
  loop.rest();
  CHECK(device.force == Vector3::Zero());
}

TEST_CASE("a servo tick allocates nothing, and the guard would see it") {
  if (!test::AllocationGuard::active()) return;
  {
    const test::AllocationGuard guard;
    auto* number = new int(3);
    CHECK(guard.count() > 0);
    delete number;
  }
  std::istringstream text("time,x,y,z,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n1,0.1,0,0,0,1,0,0\n");
  VirtualStylus device(StylusScript::parse(text, "motion.csv"), HandParameters{});
  ServoLoop loop(device, {});
  ServoLink link(1);
  const test::AllocationGuard guard;
  for (int tick = 0; tick < 2000; ++tick) {
    const std::int64_t now_ns = 1'000'000LL * tick;
    loop.read(1e-3 * tick);
    link.styluses[0].sample.put(loop.take_sample(now_ns));
    link.styluses[0].input.put({.linked = tick % 500 < 400,
                                .any_force = true,
                                .force = {.sample_time_ns = now_ns, .force = Vector3(0, 9, 0)}});
    link.styluses[0].input.receive();
    loop.apply(now_ns, link.styluses[0].input.front());
    link.samples_ready.signal();
  }
  CHECK(guard.count() == 0);
}
