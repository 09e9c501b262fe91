#include "common/error.hpp"
#include "device_bridge/commission/allowance.hpp"
#include "tests/commission/step_rig.hpp"
#include "tests/support/catch.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::commission;
using namespace irdm::test;

namespace {

/// A device with a number, of hardware or not.
struct NumberedStylus : FaultyStylus {
  bool simulated() const noexcept override { return is_simulated; }
  std::string identity() const override { return "Touch, serial number 1"; }
  bool is_simulated = false;
};

DeviceConfig with_report(double max_force, const std::string& device = "Touch, serial number 1") {
  DeviceConfig config{.type = "openhaptics"};
  config.commissioned = Report{.type = "openhaptics", .device = device};
  config.commissioned->measured.max_force = max_force;
  return config;
}

}  // namespace

TEST_CASE("commission: a device without a report may show 1 N, and the words say what to do") {
  const NumberedStylus device;
  const Allowance allowed = allowance({.type = "openhaptics", .name = "Left"}, device, 3.3);
  CHECK(allowed.force == 1.0);
  CHECK(allowed.torque == Approx(0.05));
  CHECK_THAT(allowed.words, ContainsSubstring("openhaptics device 'Left'") &&
                                ContainsSubstring("at most 1 N") &&
                                ContainsSubstring("run irdm-bridge commission"));
}

TEST_CASE("commission: a virtual device needs no report") {
  NumberedStylus device;
  device.is_simulated = true;
  const Allowance allowed = allowance({}, device, 3.3);
  CHECK(allowed.force > 1e6);
  CHECK(allowed.words.empty());
}

TEST_CASE("commission: with a report a device may show as much as it did then") {
  const NumberedStylus device;
  CHECK(allowance(with_report(3.29), device, 3.3).words.empty());
  CHECK(allowance(with_report(3.29), device, 3.3).force > 3.3);
  CHECK(allowance(with_report(3.29), device, 3.3).torque == Approx(0.05));  // none was tried
  const Allowance less = allowance(with_report(2.0), device, 3.3);
  CHECK(less.force == 2.0);
  CHECK(less.torque == Approx(0.05));
  CHECK_THAT(less.words, ContainsSubstring("commissioned up to 2 N"));
}

TEST_CASE("commission: the report of another device is refused") {
  const NumberedStylus device;
  CHECK_THROWS_WITH(allowance(with_report(3.3, "Touch, serial number 2"), device, 3.3),
                    ContainsSubstring("that of another device") &&
                        ContainsSubstring("serial number 2") &&
                        ContainsSubstring("serial number 1"));
  DeviceConfig other = with_report(3.3);
  other.commissioned->type = "haply";
  CHECK_THROWS_AS(allowance(other, device, 3.3), Error);
}
