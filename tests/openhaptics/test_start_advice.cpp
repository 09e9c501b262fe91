#include "device_bridge/openhaptics/hd_error.hpp"
#include "tests/support/catch.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm::hd;

namespace {

constexpr ErrorInfo kFault{.code = kDeviceFault};

TouchSystem healthy() {
  return {.ports = {{"/dev/ttyACM0", "2988:0302", true}},
          .setups = {{"Left", "/c/Left.config", false}, {"Right", "/c/Right.config", false}}};
}

}  // namespace

TEST_CASE("a device that does not start: its name is not set up") {
  const Advice advice = start_advice("Middle", kFault, healthy());
  CHECK_THAT(advice.what, ContainsSubstring("only: Left, Right"));
  CHECK_THAT(advice.remedy,
             ContainsSubstring("correct its name") && ContainsSubstring("leave `name` out"));
}

TEST_CASE("a device that does not start: it is not plugged in") {
  TouchSystem system = healthy();
  system.ports.clear();
  CHECK_THAT(start_advice("Left", kFault, system).what,
             ContainsSubstring("HD_DEVICE_FAULT") &&
                 ContainsSubstring("no device of 3D Systems is on USB"));
}

TEST_CASE("a device that does not start: no permission for its port") {
  TouchSystem system = healthy();
  system.ports.push_back({"/dev/hidraw3", "2988:0304", false});
  const Advice advice = start_advice("", kFault, system);
  CHECK_THAT(advice.what, ContainsSubstring("no permission for /dev/hidraw3"));
  CHECK_THAT(advice.remedy, ContainsSubstring("99-3dsystems"));
}

TEST_CASE("a device that does not start: decimal commas in its setup") {
  TouchSystem system = healthy();
  system.setups[0].decimal_comma = true;
  CHECK_THAT(start_advice("Left", kFault, system).what,
             ContainsSubstring("/c/Left.config has decimal"));
  CHECK_THAT(start_advice("Right", kFault, system).what, ContainsSubstring("HD_DEVICE_FAULT"));
}

TEST_CASE("a device that does not start: in use already, whatever else") {
  const Advice advice = start_advice("Middle", {.code = kAlreadyInitiated}, {});
  CHECK_THAT(advice.what, ContainsSubstring("in use"));
  CHECK_THAT(advice.remedy, ContainsSubstring("close the other program"));
}

TEST_CASE("a device that does not start for no reason that can be seen: the driver's own words") {
  const Advice advice = start_advice("Left", {.code = 0x0600, .internal = 7}, healthy());
  CHECK_THAT(advice.what, ContainsSubstring("HD_INVALID_LICENSE 0x0600, internal 7"));
  CHECK_THAT(advice.remedy, ContainsSubstring("licence") && ContainsSubstring("leave `name` out"));
  CHECK_THAT(start_advice("", {.code = 0x0600}, healthy()).remedy, !ContainsSubstring("name"));
}
