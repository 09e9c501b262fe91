#include <cmath>
#include <string>

#include "common/error.hpp"
#include "common/realtime/clock.hpp"
#include "device_bridge/haply/haply_device.hpp"
#include "device_bridge/haply/http_request.hpp"
#include "tests/haply/fake_service.hpp"
#include "tests/haply/served_device.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/left_out.hpp"
#include "tests/support/real_time_guard.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::test;

namespace {

// A tick that asks for this force. The stylus as it was read.
StylusPose tick(HaplyDevice& device, const Vector3& force = Vector3::Zero()) {
  const StylusPose pose = device.read(0.0);
  device.write({force});
  return pose;
}

bool ready(HaplyDevice& device) {
  tick(device);
  return device.state().ready;
}

}  // namespace

TEST_CASE("positions and forces go from the service's axes to ours and back, in 3.0 and 3.5") {
  const std::string version = GENERATE("3.0", "3.5");
  FakeService service(version);
  service.order("place 049D 0.01 -0.03 0.02");  // right, away, up
  HaplyDevice device(service.settings());
  device.open();
  REQUIRE(eventually([&] { return ready(device); }));
  CHECK(eventually([&] { return tick(device).tip.isApprox(Vector3(0.01, 0.02, 0.03)); }));
  REQUIRE(eventually([&] {
    tick(device, Vector3(0.1, 0.2, 0.3));
    return service.told().force.isApprox(Vector3(0.1, -0.3, 0.2));
  }));
  CHECK(service.told().gravity);
  REQUIRE(eventually([&] {
    tick(device, Vector3(0, std::nan(""), 0));
    return service.told().force.isZero(0.0);
  }));
  device.close();
  CHECK(service.misuses().starts_with("0 "));
  CHECK(device.report().answers > 0);
  CHECK(device.report().bad_messages == 0);
}

TEST_CASE("orientation and buttons are the grip's; a grip that is gone holds nothing") {
  FakeService service;
  service.order("turn 0.7071067811865476 0 0 0.7071067811865476");  // about up
  service.order("press ac");
  HaplyDevice device(service.settings());
  device.open();
  const StylusPose pose = tick(device);
  CHECK(pose.buttons == 5);
  CHECK((pose.orientation * Vector3::UnitX()).isApprox(-Vector3::UnitZ(), 1e-9));
  ServoLoop loop(device, FilterLimits{});
  loop.read(0.0);
  CHECK(loop.take_sample(0).orientation.isApprox(pose.orientation, 1e-9));
  service.order("grip 0");
  REQUIRE(eventually([&] { return tick(device).buttons == 0; }));
  CHECK((tick(device).orientation * Vector3::UnitX()).isApprox(-Vector3::UnitZ(), 1e-9));
}

TEST_CASE("the last that the service is told is a force of zero") {
  FakeService service;
  {
    HaplyDevice device(service.settings());
    device.open();
    REQUIRE(eventually([&] {
      tick(device, Vector3(0, 1, 0));
      return service.told().force.z() == 1.0;
    }));
  }
  const FakeService::Told told = service.told();
  CHECK(told.force.isZero(0.0));
  CHECK(told.largest == 1.0);
}

TEST_CASE("a force is zero when the servo loop is silent") {
  FakeService service;
  HaplyDevice device(service.settings());
  device.open();
  REQUIRE(eventually([&] {
    tick(device, Vector3(0, 1, 0));
    return service.told().force.z() == 1.0;
  }));
  CHECK(eventually([&] { return service.told().force.isZero(0.0); }));
}

TEST_CASE("a device is chosen by its id, and the same one is opened once") {
  FakeService service("3.5", "049D 04EA");
  HaplyDevice second(service.settings("04EA"));
  second.open();
  HaplyDevice again(service.settings("04EA"));
  CHECK_THROWS_WITH(again.open(), ContainsSubstring("Haply device 04EA: is open already"));
  HaplyDevice unknown(service.settings("1234"));
  CHECK_THROWS_WITH(unknown.open(),
                    ContainsSubstring("found: 049D, 04EA") && ContainsSubstring("Haply Hub"));
  HaplyDevice first(service.settings());
  first.open();
  HaplyDevice none(service.settings());
  CHECK_THROWS_WITH(none.open(), ContainsSubstring("or it is open already"));
  first.close();
  none.open();
  REQUIRE(eventually([&] {
    tick(none, Vector3(0, 1, 0));
    tick(second, Vector3(0, 2, 0));
    return service.told("049D").force.z() == 1.0 && service.told("04EA").force.z() == 2.0;
  }));
}

TEST_CASE("where there is no service, opening says so and what to do") {
  haply::InverseSettings settings;
  {
    FakeService service;
    settings = service.settings();
    service.kill();
  }
  HaplyDevice device(settings);
  CHECK_THROWS_WITH(device.open(),
                    ContainsSubstring("no connection to the service at 127.0.0.1:") &&
                        ContainsSubstring("start the Inverse Service"));
  FakeService other;
  other.order("garbage hello");
  HaplyDevice confused(other.settings());
  CHECK_THROWS_WITH(confused.open(), ContainsSubstring("is not understood: it is no JSON"));
}

TEST_CASE("an Inverse3 bears 10 N, and 3.3 N for long; no torque") {
  FakeService service;
  HaplyDevice device(service.settings());
  device.open();
  CHECK(device.rating().peak == 10.0);
  CHECK(device.rating().continuous == 3.3);
  CHECK(device.rating().peak_torque == 0.0);
}

TEST_CASE("a device that another session commands is not opened, unless it may be shared") {
  FakeService service;
  service.order("status 049D 1 1 1 1");
  haply::InverseSettings settings = service.settings();
  HaplyDevice refused(settings);
  CHECK_THROWS_WITH(refused.open(), ContainsSubstring("Haply device 049D: another session") &&
                                        ContainsSubstring("`shared = true`"));
  CHECK(service.told().forces == 0);
  settings.shared = true;
  HaplyDevice device(settings);
  device.open();
  CHECK(eventually([&] { return ready(device); }));
}

TEST_CASE("the service's HTTP is asked where its socket is connected, whatever the name is") {
  FakeService service("3.0");
  const boost::asio::ip::address at = boost::asio::ip::address_v4::loopback();
  const ServerAddress nowhere{"name.invalid", service.settings().old_http_port};
  const auto answer =
      haply::http_request(at, nowhere, boost::beast::http::verb::post, "/gravity_compensation",
                          haply::encode_gravity("049D", haply::ForceKey::kValues));
  REQUIRE(answer);
  CHECK(service.told().gravity);
}

TEST_CASE("each state is read once, and then it is repeated") {
  FakeService service;
  HaplyDevice device(service.settings());
  device.open();
  service.order("late 5");
  std::int64_t fresh = 0;
  std::int64_t repeated = 0;
  REQUIRE(eventually([&] {
    tick(device);
    ++(device.state().repeated ? repeated : fresh);
    return fresh > 20 && repeated > 0;
  }));
}

TEST_CASE("a servo tick with a Haply device touches neither heap, locks, exceptions nor files",
          "[unsanitized]") {
  if (!AllocationGuard::active()) return leave_out(kNotCounted);
  FakeService service;
  HaplyDevice device(service.settings());
  device.open();
  ServoLoop loop(device, FilterLimits{});
  ServoInput input{.linked = true, .any_force = true, .force = {.force = Vector3(0, 1, 0)}};
  std::string violations;
  bool shown = false;
  REQUIRE(eventually([&] {
    const RealTimeGuard guard;
    const std::int64_t now_ns = monotonic_ns();
    loop.read(0.0);
    loop.take_sample(now_ns);
    input.force.sample_time_ns = now_ns;
    loop.apply(now_ns, input);
    shown = shown || loop.shown().y() == 1.0;
    if (violations.empty()) violations = guard.violations();
    return shown;
  }));
  CHECK(violations.empty());
}
