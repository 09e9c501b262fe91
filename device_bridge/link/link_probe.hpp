#pragma once

#include "common/program/stop_signal.hpp"
#include "device_bridge/bridge_config.hpp"
#include "device_bridge/link/link_measurement.hpp"

namespace irdm {

/// Takes a stylus of the server, far away from everything, and measures for `duration`, or until a
/// signal comes. Throws when there is no session within a few seconds, or the server refuses.
/// @param config with a server; its devices are not touched
/// @param duration [s], > 0
LinkMeasurement probe_link(const BridgeConfig& config, double duration, StopSignal& stop_signal);

}  // namespace irdm
