#include <cstdint>
#include <string>
#include <vector>

#include "common/realtime/clock.hpp"
#include "device_bridge/haply/haply_device.hpp"
#include "tests/haply/fake_service.hpp"
#include "tests/haply/served_device.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/eventually.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::test;

namespace {

using Rows = std::vector<ShownTicks::Row>;

// After an outage in the middle of a contact: without force then, and a ramp when it is ready
// again. Judged by the ticks themselves, whatever else the machine does. @param since it was
// ordered then
void check_ramp(const Rows& rows, std::int64_t since_ns) {
  constexpr double kRamp = 0.5;  // [s]
  const double demand = ServedHaply::kDemand;
  std::size_t k = 1;
  while (k < rows.size() && (rows[k].time_ns < since_ns || rows[k].ready)) ++k;
  REQUIRE(k < rows.size());
  for (; k < rows.size() && !rows[k].ready; ++k) CHECK(rows[k].force == 0.0);
  REQUIRE(k < rows.size());
  double largest = 0.0;
  for (; k < rows.size(); ++k) {
    const double elapsed = 1e-9 * static_cast<double>(rows[k].time_ns - rows[k - 1].time_ns);
    CHECK(rows[k].force <= rows[k - 1].force + 1.000001 * demand * elapsed / kRamp);
    largest = std::max(largest, rows[k].force);
  }
  CHECK(largest > 0.9 * demand);
}

bool tick_ready(HaplyDevice& device) {
  device.read(0.0);
  device.write({});
  return device.state().ready;
}

// The ordered fault is on as long as this says so.
struct OrderedFault {
  const char* on;
  const char* off;
  const char* words;  // of the trouble that is told
};

}  // namespace

TEST_CASE("a service that is killed in contact and started again: no force, then a ramp") {
  FakeService service(GENERATE("3.0", "3.5"));
  ServedHaply served(service);
  REQUIRE(eventually([&] { return served.felt(service); }));
  const std::int64_t since_ns = monotonic_ns();
  const int silent = served.shown.silent;
  service.kill();
  REQUIRE(eventually([&] {
    return served.device.trouble().find("no connection to the service") != std::string::npos &&
           served.shown.silent > silent;
  }));
  service.start();
  REQUIRE(eventually([&] { return served.felt(service); }));
  served.servo->stop();
  CHECK(served.servo->report().end == ServoEnd::kStopped);
  CHECK(served.loops[0].counts().faults == 0);
  check_ramp(served.shown.rows, since_ns);
  served.device.close();
  CHECK(service.told().force.isZero(0.0));
  CHECK(service.misuses().starts_with("0 "));
  CHECK(served.device.report().reconnects > 0);
}

TEST_CASE("a fault in the middle of a contact: no force, and a ramp when it is over") {
  const OrderedFault fault = GENERATE(
      OrderedFault{"silent 1", "silent 0", "does not answer"},
      OrderedFault{"garbage {\"inverse3\":", "garbage", "is not understood: it is no JSON"},
      OrderedFault{"number null", "number", "x is no number"},
      OrderedFault{"number 1e999", "number", "is not understood"},
      OrderedFault{"late 120", "late 0", "does not answer"},
      OrderedFault{"plugged 049D 0", "plugged 049D 1",
                   "is unplugged, no force; check power and cable"},
      OrderedFault{"status 049D 0 1 1 0", "status 049D 1 1 1 0", "is not calibrated, no force"},
      OrderedFault{"status 049D 1 0 1 0", "status 049D 1 1 1 0", "is not ready, no force"},
      OrderedFault{"status 049D 1 1 0 0", "status 049D 1 1 1 0", "has no power supply"});
  CAPTURE(fault.on);
  FakeService service;
  ServedHaply served(service);
  REQUIRE(eventually([&] { return served.felt(service); }));
  const std::int64_t since_ns = monotonic_ns();
  const int silent = served.shown.silent;
  service.order(fault.on);
  REQUIRE(eventually([&] {
    return served.device.trouble().find(fault.words) != std::string::npos &&
           served.shown.silent > silent;
  }));
  const FakeService::Told before = service.told();
  REQUIRE(eventually([&] { return service.told().force.isZero(0.0); }));
  CHECK(before.largest < 1.0001 * ServedHaply::kDemand);
  service.order(fault.off);
  REQUIRE(eventually([&] { return served.felt(service); }));
  served.servo->stop();
  CHECK(served.servo->report().end == ServoEnd::kStopped);
  CHECK(served.loops[0].counts().faults == 0);
  check_ramp(served.shown.rows, since_ns);
}

TEST_CASE("a device that is not ready from the start has no force until it is") {
  FakeService service;
  service.order("status 049D 0 0 1 0");
  HaplyDevice device(service.settings());
  device.open();
  for (int k = 0; k < 20; ++k) CHECK_FALSE(tick_ready(device));
  CHECK(eventually([&] {
    const bool there = !device.read(0.0).tip.hasNaN();
    return there && ContainsSubstring("Haply device 049D: is not calibrated, no force")
                        .match(device.trouble());
  }));
  service.order("status 049D 1 1 1 0");
  CHECK(eventually([&] { return tick_ready(device) && device.trouble().empty(); }));
}

TEST_CASE("without states for 50 ms a reading is of no use, and the device not ready") {
  FakeService service;
  HaplyDevice device(service.settings());
  device.open();
  REQUIRE(eventually([&] { return tick_ready(device); }));
  service.order("silent 1");
  REQUIRE(eventually([&] { return device.read(0.0).tip.hasNaN(); }));
  CHECK_FALSE(device.state().ready);
  CHECK(device.state().repeated);
  CHECK_FALSE(device.state().lost);
  service.order("silent 0");
  CHECK(eventually([&] { return tick_ready(device); }));
}

TEST_CASE("a device that was not ready between two ticks is not ready in the next one") {
  FakeService service;
  HaplyDevice device(service.settings());
  device.open();
  REQUIRE(eventually([&] { return tick_ready(device); }));
  service.order("status 049D 1 0 1 0");
  REQUIRE(eventually([&] { return !device.trouble().empty(); }));
  service.order("status 049D 1 1 1 0");
  REQUIRE(eventually([&] { return device.trouble().empty(); }));
  CHECK_FALSE(tick_ready(device));
  CHECK(eventually([&] { return tick_ready(device); }));
}

TEST_CASE("after a short outage the force begins at zero again") {
  FakeService service;
  ServedHaply served(service);
  REQUIRE(eventually([&] { return served.felt(service); }));
  const std::int64_t since_ns = monotonic_ns();
  service.order("status 049D 1 0 1 0");
  REQUIRE(eventually([&] { return !served.device.trouble().empty(); }));
  service.order("status 049D 1 1 1 0");
  REQUIRE(eventually([&] { return served.device.trouble().empty(); }));
  REQUIRE(eventually([&] { return served.felt(service); }));
  served.servo->stop();
  check_ramp(served.shown.rows, since_ns);
}

TEST_CASE("a device that is not ready says that it shows nothing") {
  FakeService service;
  HaplyDevice device(service.settings());
  device.open();
  REQUIRE(eventually([&] { return tick_ready(device); }));
  CHECK_FALSE(device.state().off);
  service.order("status 049D 1 0 1 0");
  REQUIRE(eventually([&] { return !tick_ready(device); }));
  CHECK(device.state().off);
}
