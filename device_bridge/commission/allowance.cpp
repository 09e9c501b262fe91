#include "device_bridge/commission/allowance.hpp"

#include "common/error.hpp"
#include "common/number_text.hpp"
#include "device_bridge/safety/guards.hpp"

namespace irdm::commission {
namespace {

// No step shows a torque: a wrist whose signs are wrong is not found.
constexpr double kTorque = kLever * kUncommissionedForce;

}  // namespace

Allowance allowance(const DeviceConfig& config, const HapticDevice& device, double max_force) {
  if (device.simulated()) return {};
  const std::string label =
      config.type + " device" + (config.name.empty() ? "" : " " + in_quotes(config.name));
  if (!config.commissioned) {
    return {.force = kUncommissionedForce,
            .torque = kTorque,
            .words = label +
                     ": not commissioned, at most 1 N; run irdm-bridge commission, and name "
                     "its report in the key `commissioned`"};
  }
  const Report& report = *config.commissioned;
  if (report.type != config.type || report.device != device.identity()) {
    throw Error(label,
                "its report is that of another device: " + in_quotes(report.type) + ", " +
                    in_quotes(report.device) + ", not " + in_quotes(device.identity()),
                "name the report of this one, or run irdm-bridge commission");
  }
  const double force = *report.measured.max_force;
  Allowance allowed{.torque = kTorque};
  constexpr double kRounded = 0.99;  // a report has four digits
  if (force >= kRounded * max_force) return allowed;
  allowed.force = force;
  allowed.words = label + ": commissioned up to " + number_text(force) +
                  " N, and no more is shown; run irdm-bridge commission with this max_force";
  return allowed;
}

}  // namespace irdm::commission
