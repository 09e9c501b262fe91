#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <vector>

#include "common/error.hpp"
#include "device_bridge/forcedimension/forcedimension_device.hpp"
#include "device_bridge/safety/sensor_plausibility.hpp"
#include "tests/bridge/served_device.hpp"
#include "tests/forcedimension/fake_api.hpp"
#include "tests/support/allocation_guard.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/left_out.hpp"
#include "tests/support/temporary_folder.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::test;

namespace {

Vector3 force_of(int index) {
  Vector3 force;
  fakedhd_force(index, force.data());
  return force;
}

Vector3 torque_of(int index) {
  Vector3 torque;
  fakedhd_torque(index, torque.data());
  return torque;
}

}  // namespace

TEST_CASE("libdhd.so is looked for by its usual names, or by the one that is given alone") {
  ::unsetenv("FORCEDIMENSION_LIB");
  ::unsetenv("FDSDK");
  CHECK(dhd::library_names().back() == "libdhd.so");
  // As the SDK ships it: no links, libdrd before libdhd, the newest first.
  const TemporaryFolder sdk;
  const std::filesystem::path folder = sdk.path() / "lib/release/lin-x86_64-gcc";
  std::filesystem::create_directories(folder);
  for (const char* name : {"libdhd.so.3.17.5", "libdrd.so.3.9.1", "libdrd.so.3.17.5"}) {
    std::ofstream(folder / name) << "x";
  }
  ::setenv("FDSDK", sdk.path().c_str(), 1);
  const std::vector<std::string> names = dhd::library_names();
  CHECK(names[0] == (folder / "libdrd.so.3.17.5").string());
  CHECK(names[1] == (folder / "libdrd.so.3.9.1").string());
  CHECK(names[2] == (folder / "libdhd.so.3.17.5").string());
  ::unsetenv("FDSDK");
  ::setenv("FORCEDIMENSION_LIB", "/opt/libdrd.so", 1);
  CHECK(dhd::library_names() == std::vector<std::string>{"/opt/libdrd.so"});
  ::unsetenv("FORCEDIMENSION_LIB");
  CHECK_THROWS_WITH(
      dhd::load_library({"/nowhere/libdhd.so"}),
      ContainsSubstring("/nowhere/libdhd.so") && ContainsSubstring("install the 64-bit"));
}

TEST_CASE("a device of Force Dimension is opened by its number or as the first, and closed") {
  fakedhd_reset();
  ForceDimensionDevice second("1", fake_api());
  second.open();
  CHECK(fakedhd_is_open(1) == 1);
  CHECK(fakedhd_force_is_on(1) == 1);
  CHECK(fakedhd_compensates(1) == 1);
  CHECK(fakedhd_is_open(0) == 0);
  {
    ForceDimensionDevice first("", fake_api());
    first.open();
    CHECK(fakedhd_is_open(0) == 1);
    ForceDimensionDevice again("0", fake_api());
    CHECK_THROWS_WITH(again.open(), ContainsSubstring("is open already"));
    ForceDimensionDevice by_serial("10777", fake_api());
    CHECK_THROWS_WITH(by_serial.open(), ContainsSubstring("is open already"));
    ForceDimensionDevice unknown("10778", fake_api());
    CHECK_THROWS_WITH(unknown.open(), ContainsSubstring("cannot be opened: no device found"));
  }
  CHECK(fakedhd_is_open(0) == 0);
  CHECK(fakedhd_force_is_on(0) == 0);
  ForceDimensionDevice nameless("Left", fake_api());
  CHECK_THROWS_WITH(nameless.open(), ContainsSubstring("has no number"));
}

TEST_CASE("positions, orientations and forces are taken from the driver's axes to ours and back") {
  fakedhd_reset();
  ForceDimensionDevice device("", fake_api());
  device.open();
  fakedhd_place(0, 0.03, 0.01, 0.02);  // towards the person, right, up
  fakedhd_press(0, 2);
  // A quarter turn about the driver's z, which is up: our y.
  const std::array<double, 9> turned{0, -1, 0, 1, 0, 0, 0, 0, 1};
  fakedhd_turn(0, turned.data());
  const StylusPose pose = device.read(0.0);
  CHECK(pose.tip.isApprox(Vector3(0.01, 0.02, 0.03)));
  CHECK(pose.buttons == 2);
  CHECK((pose.orientation * Vector3::UnitY()).isApprox(Vector3::UnitY()));
  CHECK((pose.orientation * Vector3::UnitZ()).isApprox(Vector3::UnitX()));
  device.write({Vector3(1, 2, 3)});
  CHECK(force_of(0).isApprox(Vector3(3, 1, 2)));
  device.write({Vector3(0, std::nan(""), 0)});
  CHECK(force_of(0).isZero(0.0));
}

TEST_CASE("a device with an active wrist gets torques, in the driver's axes, and others none") {
  fakedhd_reset();
  fakedhd_activate_wrist(1);
  ForceDimensionDevice passive("0", fake_api());
  passive.open();
  CHECK(passive.rating().peak_torque == 0.0);
  passive.write({Vector3(1, 2, 3), Vector3(0.1, 0.2, 0.3)});
  CHECK(force_of(0).isApprox(Vector3(3, 1, 2)));
  CHECK(torque_of(0).isZero(0.0));
  ForceDimensionDevice active("1", fake_api());
  active.open();
  CHECK(active.rating().peak_torque > 0.0);
  active.write({Vector3(1, 2, 3), Vector3(0.1, 0.2, 0.3)});
  CHECK(force_of(1).isApprox(Vector3(3, 1, 2)));
  CHECK(torque_of(1).isApprox(Vector3(0.3, 0.1, 0.2)));
  active.write({Vector3(1, 2, 3), Vector3(0.1, std::nan(""), 0.3)});
  CHECK(force_of(1).isApprox(Vector3(3, 1, 2)));
  CHECK(torque_of(1).isZero(0.0));
  active.write({Vector3(1, 2, 3), Vector3(0.1, 0.2, 0.3)});
  active.close();
  CHECK(force_of(1).isZero(0.0));
  CHECK(torque_of(1).isZero(0.0));
}

TEST_CASE("readings that fail are of no use, and after fifty the device is lost") {
  fakedhd_reset();
  ForceDimensionDevice device("", fake_api());
  device.open();
  fakedhd_unplug(0, 1);
  for (int tick = 0; tick < 49; ++tick) CHECK(device.read(0.0).tip.hasNaN());
  fakedhd_unplug(0, 0);
  CHECK_FALSE(device.read(0.0).tip.hasNaN());
  CHECK_FALSE(device.state().lost);
  fakedhd_unplug(0, 1);
  for (int tick = 0; tick < 50; ++tick) device.read(0.0);
  CHECK(device.state().lost);
  CHECK(device.state().failed);
  CHECK_THAT(device.trouble(), ContainsSubstring("does not answer any more"));
}

namespace {

// So many ticks with this force. Whether it was ready in the last of them.
bool tick(ForceDimensionDevice& device, int ticks, const Vector3& force = Vector3::Zero()) {
  for (int k = 0; k < ticks; ++k) {
    device.read(0.0);
    device.write({force});
  }
  return device.state().ready;
}

constexpr int kSeen = 10;  // ticks: 10 ms

}  // namespace

TEST_CASE("a device that turns its force off is not ready until that is on again") {
  fakedhd_reset();
  ForceDimensionDevice device("", fake_api());
  device.open();
  CHECK(tick(device, kSeen));
  CHECK(device.trouble().empty());
  SECTION("the person's button stays off until it is pressed again") {
    fakedhd_force_off(0, 1);
    CHECK_FALSE(tick(device, kSeen));
    CHECK_THAT(device.trouble(), ContainsSubstring("the force button"));
    CHECK_FALSE(tick(device, 2000));
    CHECK(fakedhd_turned_on(0) == 1);
    fakedhd_force_off(0, 0);
    CHECK(tick(device, kSeen));
    CHECK(device.trouble().empty());
  }
  SECTION("what the watchdog or the velocity limit turned off comes back after a pause") {
    const auto [cause, words] =
        GENERATE(table<int, const char*>({{3, "its watchdog"}, {2, "too fast"}}));
    fakedhd_force_off(0, cause);
    CHECK_FALSE(tick(device, kSeen));
    CHECK_THAT(device.trouble(), ContainsSubstring(words));
    CHECK_FALSE(tick(device, 400));
    CHECK(fakedhd_turned_on(0) == 1);
    CHECK(tick(device, 200));
    CHECK(fakedhd_turned_on(0) == 2);
  }
  SECTION("a cable that is out is a device that is lost") {
    fakedhd_force_off(0, 5);
    CHECK_FALSE(tick(device, kSeen));
    CHECK(device.state().lost);
  }
}

TEST_CASE("a device that is not initialised has no force, and moves by itself only when asked to") {
  fakedhd_reset();
  fakedhd_initialised(0, 0);
  {
    ForceDimensionDevice device("", fake_api());
    device.open();
    CHECK_FALSE(tick(device, 3 * kSeen));
    CHECK_THAT(device.trouble(), ContainsSubstring("not initialised"));
    fakedhd_initialised(0, 1);  // by the vendor's program, or by hand
    CHECK(tick(device, kSeen));
  }
  fakedhd_initialised(0, 0);
  ForceDimensionDevice moves("", fake_api(), true);
  moves.open();
  CHECK(tick(moves, kSeen));
  moves.close();
  fakedhd_initialised(0, 0);
  dhd::Api only_dhd = fake_api();
  only_dhd.auto_init = nullptr;
  ForceDimensionDevice cannot("", only_dhd, true);
  CHECK_THROWS_WITH(cannot.open(), ContainsSubstring("auto_init needs libdrd"));
  CHECK(fakedhd_is_open(0) == 0);
}

TEST_CASE("the largest force is the model's, and the driver cuts off there, too") {
  fakedhd_reset();
  fakedhd_model(0, "Falcon", 60);
  {
    fakedhd_model(1, "sigma.7", 104);
    fakedhd_activate_wrist(1);
    ForceDimensionDevice sigma("1", fake_api());
    sigma.open();
    CHECK(sigma.rating().peak == 12.0);
    CHECK(sigma.rating().peak_torque == 0.2);
  }
  ForceDimensionDevice falcon("0", fake_api());
  falcon.open();
  CHECK(falcon.rating().peak == 8.0);
  CHECK(falcon.rating().peak_torque == 0.0);
  CHECK(fakedhd_max_force(0) == 8.0);
  fakedhd_reset();
  fakedhd_model(1, "lambda.7", 108);
  ForceDimensionDevice other("1", fake_api());
  other.open();
  CHECK(std::isinf(other.rating().peak));
  CHECK(fakedhd_max_force(1) == 0.0);
}

TEST_CASE("a gripper that closes is a button, and the later omega.3 has its button at bit 0") {
  fakedhd_reset();
  fakedhd_give_gripper(0);
  fakedhd_model(1, "omega.3", 110);
  ForceDimensionDevice gripper("0", fake_api());
  gripper.open();
  CHECK(gripper.read(0.0).buttons == 0);
  fakedhd_close_gripper(0, 1);
  CHECK(gripper.read(0.0).buttons == 1);
  ForceDimensionDevice omega("1", fake_api());
  omega.open();
  fakedhd_press(1, 2);
  CHECK(omega.read(0.0).buttons == 1);
}

TEST_CASE("a reading that is repeated says nothing of a speed, and the next has the way of both") {
  fakedhd_reset();
  ForceDimensionDevice device("", fake_api());
  device.open();
  SensorPlausibility sense({}, {});
  std::int64_t now_ns = 0;
  double fastest = 0.0;
  for (int k = 0; k < 200; ++k) {
    fakedhd_place(0, 0.0, 0.0, 0.0005 * k);  // 0.5 m/s
    if (k % 4 == 3) fakedhd_repeat(0, 1);
    const StylusPose pose = device.read(0.0);
    CHECK(device.state().repeated == (k % 4 == 3));
    const ReadingVerdict verdict = device.state().repeated
                                       ? sense.repeat(now_ns)
                                       : sense.look(now_ns, pose.tip, pose.orientation);
    CHECK(verdict == ReadingVerdict::kGood);
    if (k > 0) CHECK(sense.velocity().linear.y() == Approx(0.5));
    fastest = std::max(fastest, sense.velocity().linear.norm());
    now_ns += 1'000'000;
  }
  CHECK(fastest == Approx(0.5));
  // Nothing newer for too long is of no use.
  ReadingVerdict verdict = ReadingVerdict::kGood;
  for (int k = 0; k < 60; ++k) verdict = sense.repeat(now_ns += 1'000'000);
  CHECK(verdict == ReadingVerdict::kFault);
}

// What is not taken leaves on what was shown before, which nobody knows to be right.
TEST_CASE("a driver that takes no force any more has lost its device") {
  fakedhd_reset();
  ForceDimensionDevice device("", fake_api());
  device.open();
  device.write({Vector3(0, 1, 0)});
  fakedhd_refuse_forces(0, 1);
  for (int k = 0; k < 49; ++k) device.write({});
  CHECK(device.state().saturated);
  CHECK_FALSE(device.state().lost);
  fakedhd_refuse_forces(0, 0);
  device.write({});
  CHECK_FALSE(device.state().saturated);
  fakedhd_refuse_forces(0, 1);
  for (int k = 0; k < 50; ++k) device.write({});
  CHECK(device.state().failed);
  CHECK(device.state().lost);
  CHECK_THAT(device.trouble(), ContainsSubstring("does not answer any more"));
}

TEST_CASE("a force that is more than the motors give is said to be, as long as it is asked for") {
  fakedhd_reset();
  fakedhd_model(0, "delta.3", 63);
  ForceDimensionDevice device("0", fake_api());
  device.open();
  device.write({Vector3(0, 5, 0)});
  CHECK_FALSE(device.state().saturated);
  device.write({Vector3(0, 15, 0)});
  CHECK(device.state().saturated);
  CHECK(force_of(0).norm() == Approx(12.0));
  device.write({});
  CHECK_FALSE(device.state().saturated);
}

// Up against a force that pushes up, and down again.
TEST_CASE("the safety filter hears of forces that the motors cut off") {
  const auto taken = [](double newton) {
    fakedhd_reset();
    fakedhd_model(0, "delta.3", 63);
    ForceDimensionDevice device("0", fake_api());
    device.open();
    ServoLoop loop(device, {.max_force = 20.0, .continuous_force = 20.0});
    std::int64_t now_ns = 0;
    const auto move = [&](double up, int ticks) {
      for (int k = 0; k < ticks; ++k) {
        fakedhd_place(0, 0.0, 0.0, up * k);
        loop.read(0.0);
        now_ns += 1'000'000;
        loop.apply(now_ns, {.linked = true,
                            .any_force = true,
                            .force = {.sample_time_ns = now_ns,
                                      .contact = ContactState::kHeld,
                                      .force = Vector3(0, newton, 0)}});
      }
      return loop.filter().port_energy();
    };
    const double before = move(0.0, 1000);
    return move(-1e-5, 100) - before;
  };
  CHECK(taken(10.0) == Approx(10.0 * 99e-5));
  CHECK(taken(15.0) == 0.0);
}

TEST_CASE("a tick with a device of Force Dimension allocates nothing", "[unsanitized]") {
  if (!AllocationGuard::active()) return leave_out(kNotCounted);
  fakedhd_reset();
  ForceDimensionDevice device("", fake_api());
  device.open();
  const AllocationGuard guard;
  for (int tick = 0; tick < 100; ++tick) {
    device.read(0.0);
    device.write({Vector3(0, 1, 0)});
  }
  CHECK(guard.count() == 0);
}

namespace {

using Served = ServedDevice<ForceDimensionDevice>;

bool felt() {
  return force_of(0).norm() > 0.95 * Served::kDemand;
}

}  // namespace

TEST_CASE("the driver hears of the bridge in every tick, before any server is there") {
  fakedhd_reset();
  Served served("", fake_api());
  CHECK(eventually([] { return fakedhd_forces(0) > 100; }));
  CHECK(force_of(0).isZero(0.0));
  served.servo->stop();
}

TEST_CASE("a device of Force Dimension that is unplugged ends the servo thread") {
  fakedhd_reset();
  Served served("", fake_api());
  served.begin_session();
  REQUIRE(eventually(felt));
  fakedhd_unplug(0, 1);
  REQUIRE(served.done.wait(kDeadlineMs));
  served.servo->stop();
  CHECK(served.servo->report().end == ServoEnd::kDeviceLost);
  CHECK(served.loops[0].counts().faults > 0);
}

// Judged by the ticks themselves, whatever else the machine does.
TEST_CASE("a force that the device turned off in the middle of a contact comes back as a ramp") {
  constexpr double kRamp = 0.5;     // [s]
  constexpr int kPauseTicks = 400;  // without force at least
  fakedhd_reset();
  Served served("", fake_api());
  served.begin_session();
  REQUIRE(eventually(felt));
  const int off = fakedhd_forces(0);
  fakedhd_force_off(0, GENERATE(3, 2));
  REQUIRE(eventually([&] { return fakedhd_forces(0) > off + kPauseTicks && felt(); }));
  served.servo->stop();
  CHECK(served.servo->report().end == ServoEnd::kStopped);
  const std::vector<ShownTicks::Row>& rows = served.shown.rows;
  std::size_t k = 1;
  while (k < rows.size() && (rows[k].ready || !rows[k - 1].ready)) ++k;
  REQUIRE(k < rows.size());
  int silent = 0;
  for (; k < rows.size() && (silent == 0 || rows[k].force == 0.0); ++k) {
    if (rows[k].force == 0.0) ++silent;
  }
  CHECK(silent > kPauseTicks);
  REQUIRE(k < rows.size());
  double largest = 0.0;
  for (; k < rows.size(); ++k) {
    const double elapsed = 1e-9 * static_cast<double>(rows[k].time_ns - rows[k - 1].time_ns);
    CHECK(rows[k].force <= rows[k - 1].force + 1.000001 * Served::kDemand * elapsed / kRamp);
    largest = std::max(largest, rows[k].force);
  }
  CHECK(largest > 0.9 * Served::kDemand);
}
