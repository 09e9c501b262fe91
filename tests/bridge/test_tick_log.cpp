#include "device_bridge/blackbox/tick_log.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;

namespace {

/// A stylus that feels something.
TickRow felt(int stylus = 0) {
  TickRow row;
  row.stylus = stylus;
  row.linked = true;
  row.session = 1;
  row.state = FilterState::kEngaged;
  row.force = Vector3(0, 1, 0);
  return row;
}

/// The fault in `row` after `before`; empty: none.
std::string fault_in(const TickRow& row, const TickRow& before = felt()) {
  TickLog log;
  log.put(before);
  CHECK_FALSE(log.take());
  log.put(row);
  const std::optional<Fault> fault = log.take();
  log.put(row);
  CHECK_FALSE(log.take());  // said once
  return fault ? fault->kind : "";
}

template <typename Change>
TickRow felt_but(const Change& change) {
  TickRow row = felt();
  change(row);
  return row;
}

}  // namespace

TEST_CASE("tick log: what fails at the device and in the filter is a fault, once") {
  CHECK(fault_in(felt()).empty());
  CHECK(fault_in(felt_but([](TickRow& row) { row.device.lost = true; })) == "device lost");
  CHECK(fault_in(felt_but([](TickRow& row) { row.device.failed = true; })) == "device failed");
  CHECK(fault_in(felt_but([](TickRow& row) { row.state = FilterState::kFault; })) ==
        "fault of the safety filter");
  CHECK(fault_in(felt_but([](TickRow& row) { row.state = FilterState::kArmed; })).empty());
  CHECK(fault_in(felt_but([](TickRow& row) { row.device.ready = false; })).empty());
}

TEST_CASE("tick log: a connection that is lost is a fault while a force is felt") {
  const TickRow lost = felt_but([](TickRow& row) { row.linked = false; });
  const TickRow again = felt_but([](TickRow& row) { row.session = 2; });
  CHECK(fault_in(lost) == "connection lost with a force");
  CHECK(fault_in(again) == "connection lost with a force");
  CHECK(fault_in(lost, felt_but([](TickRow& row) { row.force.setZero(); })).empty());
  CHECK(fault_in(lost, felt_but([](TickRow& row) { row.linked = false; })).empty());
  CHECK(fault_in(lost, felt_but([](TickRow& row) {
                   row.force.setZero();
                   row.torque = Vector3(0.1, 0, 0);
                 })) == "connection lost with a force");
  CHECK(fault_in(felt_but([](TickRow& row) {
          row.linked = false;
          row.server_ended = true;
        })).empty());
}

TEST_CASE("tick log: each stylus is compared with itself") {
  TickLog log;
  log.put(felt(0));
  TickRow other = felt(1);
  other.device.failed = true;
  log.put(other);
  const std::optional<Fault> fault = log.take();
  REQUIRE(fault);
  CHECK(fault->detail == "stylus 1");
  log.put(felt(0));
  log.put(other);
  CHECK_FALSE(log.take());
}
