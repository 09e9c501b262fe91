#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "device_bridge/servo_link.hpp"
#include "device_bridge/servo_loop.hpp"
#include "device_bridge/virtual_stylus.hpp"
#include "tests/support/allocation_guard.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/left_out.hpp"

using namespace irdm;

namespace {

/// A device that shows what was done to it.
class ProbeDevice : public HapticDevice {
 public:
  void open() override {}
  void close() noexcept override {}
  StylusPose read(double) noexcept override { return pose; }
  void write(const Wrench& given) noexcept override {
    force = given.force;
    torque = given.torque;
  }
  bool simulated() const noexcept override { return true; }
  double duration() const noexcept override { return 1.0; }

  DeviceState state() const noexcept override { return said; }

  StylusPose pose;
  DeviceState said;
  Vector3 force = Vector3::Constant(7.0);
  Vector3 torque = Vector3::Constant(7.0);
};

constexpr std::int64_t kTickNs = 1'000'000;

// So many ticks with a fresh force; the time after them.
std::int64_t show(ServoLoop& loop, std::int64_t now_ns, int ticks, const Vector3& force_W) {
  for (int i = 0; i < ticks; ++i, now_ns += kTickNs) {
    loop.read(0.0);
    loop.apply(
        now_ns,
        {.linked = true, .any_force = true, .force = {.sample_time_ns = now_ns, .force = force_W}});
  }
  return now_ns;
}

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
}

TEST_CASE("servo loop that is armed by a button shows no force until one goes down") {
  ProbeDevice device;
  ServoLoop loop(device, {}, {}, true);
  loop.restart();
  const Vector3 force(0, 0.25, 0);
  device.pose.buttons = 2;  // held from the start on, which is no press
  std::int64_t now_ns = show(loop, 0, 200, force);
  CHECK(loop.awaits_button());
  CHECK(device.force == Vector3::Zero());
  CHECK(loop.peak_force() == 0.0);
  device.pose.buttons = 0;
  now_ns = show(loop, now_ns, 200, force);
  CHECK(device.force == Vector3::Zero());
  device.pose.buttons = 1;
  now_ns = show(loop, now_ns, 1, force);
  CHECK_FALSE(loop.awaits_button());
  now_ns = show(loop, now_ns, 20, force);
  CHECK(device.force.isApprox(force));
  // A press is enough; later ones change nothing.
  device.pose.buttons = 0;
  now_ns = show(loop, now_ns, 20, force);
  CHECK(device.force.isApprox(force));

  // A device that was not ready is armed by another press, none while it is not ready.
  device.said.ready = false;
  now_ns = show(loop, now_ns, 5, force);
  device.pose.buttons = 1;
  now_ns = show(loop, now_ns, 5, force);
  CHECK(device.force == Vector3::Zero());
  device.said.ready = true;
  now_ns = show(loop, now_ns, 200, force);
  CHECK(device.force == Vector3::Zero());
  device.pose.buttons = 0;
  now_ns = show(loop, now_ns, 5, force);
  device.pose.buttons = 4;
  now_ns = show(loop, now_ns, 20, force);
  CHECK(device.force.isApprox(force));

  // So is each run of the device.
  loop.restart();
  now_ns = show(loop, now_ns, 200, force);
  CHECK(device.force == Vector3::Zero());
}

TEST_CASE("servo loop shows the filtered force and remembers the largest") {
  ProbeDevice device;
  ServoLoop loop(device, {.max_force = 2.0});
  loop.apply(0, {.linked = true, .any_force = true, .force = {.force = Vector3(0, 1, 0)}});
  CHECK(device.force == Vector3::Zero());  // nobody knows yet where it is
  std::int64_t now_ns = show(loop, 0, 3, Vector3::Zero());
  now_ns = show(loop, now_ns, 10, Vector3(0, 5, 0));
  CHECK(device.force.isApprox(Vector3(0, 2, 0)));
  CHECK(loop.peak_force() == Approx(2.0));
  loop.rest();
  CHECK(device.force == Vector3::Zero());
  now_ns = show(loop, now_ns, 3, Vector3(0, std::nan(""), 0));
  device.pose.tip.x() = std::nan("");
  show(loop, now_ns, 3, Vector3(0, 1, 0));
  CHECK(loop.counts().demands == 3);
  CHECK(loop.counts().readings == 3);
  CHECK(loop.counts().faults == 1);
  CHECK(device.force == Vector3::Zero());
  device.pose.tip.x() = 0.0;
  loop.restart();
  now_ns = show(loop, now_ns, 3, Vector3::Zero());
  show(loop, now_ns, 10, Vector3(0, 1, 0));
  CHECK(device.force.isApprox(Vector3(0, 1, 0)));
  CHECK(loop.counts().faults == 1);
}

TEST_CASE("servo loop: a device that fails before its stylus is armed stays without force") {
  ProbeDevice device;
  ServoLoop loop(device, {.needed_success = 0.9});
  loop.restart(true);
  std::int64_t now_ns = show(loop, 0, 10, Vector3(0, 1, 0));
  CHECK(loop.filter().state() == FilterState::kDisarmed);
  CHECK(loop.filter().waits());
  device.said.failed = true;
  now_ns = show(loop, now_ns, 1, Vector3(0, 1, 0));
  CHECK(loop.filter().state() == FilterState::kFault);
  device.said.failed = false;
  show(loop, now_ns, 1000, Vector3(0, 1, 0));
  CHECK(loop.filter().state() == FilterState::kFault);
  CHECK(device.force == Vector3::Zero());
  CHECK(loop.counts().faults == 1);
}

TEST_CASE("servo loop: a device that shows nothing is sent nothing at once, and then a ramp") {
  ProbeDevice device;
  ServoLoop loop(device, {});
  std::int64_t now_ns = show(loop, 0, 3, Vector3::Zero());
  now_ns = show(loop, now_ns, 20, Vector3(0, 3, 0));
  CHECK(device.force == Vector3(0, 3, 0));
  device.said.off = true;
  device.said.ready = GENERATE(true, false);
  now_ns = show(loop, now_ns, 1, Vector3(0, 3, 0));
  CHECK(device.force.isZero(0.0));
  CHECK(loop.shown().isZero(0.0));
  device.said = DeviceState{};
  double rise = 0.0;
  for (int tick = 0; tick < 700; ++tick) {
    const double before = device.force.y();
    now_ns = show(loop, now_ns, 1, Vector3(0, 3, 0));
    rise = std::max(rise, device.force.y() - before);
  }
  CHECK(rise < 1.001 * 3.0 / 500.0);
  CHECK(device.force.isApprox(Vector3(0, 3, 0)));
}

TEST_CASE("servo loop takes a device to W and the force back to it") {
  ProbeDevice device;
  device.pose = {.tip = Vector3(0.1, 0.2, 0.3), .buttons = 5};
  const DeviceMapping mapping{
      .workspace = {.position = Vector3(1, 2, 3),
                    .rotation = Quaternion(Eigen::AngleAxisd(M_PI / 2, Vector3::UnitY())),
                    .scale = 2.0,
                    .force_scale = 0.5}};
  ServoLoop loop(device, {.max_force = 3.0}, mapping);
  loop.read(0.0);
  const StylusSample sample = loop.take_sample(0);
  CHECK(sample.tip.isApprox(Vector3(1.6, 2.4, 2.8)));
  CHECK(sample.orientation.isApprox(mapping.workspace.rotation));
  CHECK(sample.buttons == (kGrabButton | kResetButton));
  std::int64_t now_ns = show(loop, 0, 3, Vector3::Zero());
  now_ns = show(loop, now_ns, 10, Vector3(4, 0, 0));
  CHECK(device.force.isApprox(Vector3(0, 0, 2)));
  // The limit is one of the force at the device.
  show(loop, now_ns, 10, Vector3(20, 0, 0));
  CHECK(device.force.isApprox(Vector3(0, 0, 3)));
}

TEST_CASE("servo loop: the torque goes to the device with the force, and fades with it") {
  ProbeDevice device;
  const Quaternion turned(Eigen::AngleAxisd(M_PI / 2, Vector3::UnitY()));
  const DeviceMapping mapping{.workspace = {.rotation = turned, .scale = 2.0, .force_scale = 0.5}};
  ServoLoop loop(device, {.max_torque = 0.1}, mapping);
  ServoInput input{.linked = true, .any_force = true};
  std::int64_t now_ns = 0;
  const auto run = [&](int ticks) {
    for (int i = 0; i < ticks; ++i, now_ns += kTickNs) {
      if (input.linked) input.force.sample_time_ns = now_ns;
      loop.read(0.0);
      loop.apply(now_ns, input);
    }
  };
  run(3);
  input.force.force = Vector3(2, 0, 0);
  input.force.torque = Vector3(0.2, 0, 0);
  run(20);
  CHECK(device.force.isApprox(Vector3(0, 0, 1)));
  CHECK(device.torque.isApprox(Vector3(0, 0, 0.05)));  // force_scale / scale of it
  CHECK(loop.shown_torque() == device.torque);
  CHECK(loop.peak_torque() == Approx(0.05));
  device.pose.buttons = 2;  // the clutch
  run(60);
  CHECK(device.force.isZero(0.0));
  CHECK(device.torque.isZero(0.0));
  device.pose.buttons = 0;
  run(60);
  CHECK(device.torque.isApprox(Vector3(0, 0, 0.05)));
  input.linked = false;
  run(15);
  CHECK(device.torque.norm() < 0.05);
  CHECK(device.torque.norm() / 0.05 == Approx(device.force.norm()));
  run(20);
  CHECK(device.force.isZero(0.0));
  CHECK(device.torque.isZero(0.0));
}

TEST_CASE("servo loop: clutched, the tip stays in W, the force fades, the orientation follows") {
  ProbeDevice device;
  const DeviceMapping mapping{.workspace = {.position = Vector3(0, 1, 0), .scale = 2.0}};
  ServoLoop loop(device, {}, mapping);
  std::int64_t now_ns = show(loop, 0, 3, Vector3::Zero());
  now_ns = show(loop, now_ns, 10, Vector3(0, 1, 0));
  Vector3 last_tip(0, 1, 0);
  double last_force = 1.0;
  Vector3 held = last_tip;
  // The device moves evenly all the time; from 100 to 300 ms the clutch is down.
  for (int tick = 0; tick < 500; ++tick, now_ns += kTickNs) {
    const bool down = tick >= 100 && tick < 300;
    const Quaternion turned(Eigen::AngleAxisd(0.001 * tick, Vector3::UnitZ()));
    device.pose = {
        .tip = Vector3(1e-4 * tick, 0, 0), .orientation = turned, .buttons = down ? 3u : 1u};
    loop.read(0.0);
    const StylusSample sample = loop.take_sample(now_ns);
    CHECK(sample.buttons == kGrabButton);
    CHECK(sample.orientation.isApprox(turned));
    REQUIRE((sample.tip - last_tip).norm() < 2.001e-4);
    if (tick == 100) held = sample.tip;
    if (down) CHECK(sample.tip == held);
    last_tip = sample.tip;
    loop.apply(now_ns, {.linked = true,
                        .any_force = true,
                        .force = {.sample_time_ns = now_ns, .force = Vector3(0, 1, 0)}});
    REQUIRE(std::abs(device.force.y() - last_force) < 0.0201);
    last_force = device.force.y();
    if (down && tick > 150) CHECK(last_force == 0.0);
  }
  CHECK(last_force == 1.0);
  CHECK(last_tip.isApprox(held + Vector3(2e-4 * 199, 0, 0)));
  loop.restart();
  loop.read(0.0);
  CHECK(loop.take_sample(0).tip.isApprox(Vector3(2e-4 * 499, 1, 0)));
}

TEST_CASE("a servo tick allocates nothing, and the guard would see it") {
  if (!test::AllocationGuard::active()) return test::leave_out(test::kNotCounted);
  {
    const test::AllocationGuard guard;
    auto* number = new int(3);
    CHECK(guard.count() > 0);
    delete number;
  }
  std::istringstream text(
      "time,x,y,z,qw,qx,qy,qz,button\n0,0,0,0,1,0,0,0,7\n1,0.1,0,0,0,1,0,0,0\n");
  VirtualStylus device(StylusScript::parse(text, "motion.csv"),
                       HandParameters{.turn = TurnParameters{}});
  // Every bit of the button field does something, clutch and reset included.
  ServoLoop loop(device, {.max_torque = 0.15}, {.workspace = {.scale = 2.0, .force_scale = 0.5}});
  ServoLink link(1);
  const test::AllocationGuard guard;
  for (int tick = 0; tick < 2000; ++tick) {
    const std::int64_t now_ns = 1'000'000LL * tick;
    loop.read(1e-3 * tick);
    link.styluses[0].sample.put(loop.take_sample(now_ns));
    link.styluses[0].input.put(
        {.linked = tick % 500 < 400,
         .any_force = true,
         .force = {
             .sample_time_ns = now_ns, .force = Vector3(0, 9, 0), .torque = Vector3(0, 0, 0.5)}});
    link.styluses[0].input.receive();
    loop.apply(now_ns, link.styluses[0].input.front());
    link.samples_ready.signal();
  }
  CHECK(guard.count() == 0);
}

// A wall at y = 0 that gives way by 1 mm per newton.
TEST_CASE("servo loop: the server is told of the force that the device shows") {
  ContactModel wall;
  wall.valid = true;
  wall.dt = 0.002;
  wall.horizon = 25;
  wall.body = {1.0, Matrix3::Identity(), Support::kFixed};
  wall.normal = Vector3(0, 1, 0);
  wall.response[0] = 1e-3 * Matrix3::Identity();
  REQUIRE(check(wall) == ContactModelFault::kNone);
  ProbeDevice device;
  DeviceMapping mapping;
  mapping.workspace.rotation = Eigen::AngleAxisd(0.5 * M_PI, Vector3::UnitX());
  mapping.workspace.force_scale = 2.0;
  ServoLoop loop(device, {.max_force = 0.5}, mapping);
  loop.restart();
  loop.predict(wall.dt, kTickNs);
  double told = 0.0;
  for (int tick = 0; tick < 2000; ++tick) {
    const std::int64_t now_ns = tick * kTickNs;
    const double depth = tick < 100 ? -1e-3 : 1e-3;  // in W, where y is D's -z
    device.pose.tip = mapping.workspace.rotation.conjugate() * Vector3(0, -depth, 0);
    loop.read(0.0);
    loop.take_sample(now_ns);
    if (tick % 2 == 0) {
      wall.step = wall.newest = static_cast<std::uint64_t>(tick / 2);
      if (tick > 110) wall.state = ContactState::kTouching;
      loop.receive(wall, now_ns);
    }
    loop.end_steps(now_ns);
    loop.apply(now_ns, {.linked = true});
    const AppliedForces* const applied = loop.applied();
    if (applied == nullptr) continue;
    told = std::max(told, applied->past[0].force.norm());
    // In W the device's force is half as large; on the object it is turned round.
    const Vector3 shown = 0.5 * (mapping.workspace.rotation * loop.shown());
    CHECK((applied->past[0].force + shown).norm() < 1e-12);
  }
  CHECK(told == Approx(0.25));
}
