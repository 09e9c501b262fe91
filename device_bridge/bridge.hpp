#pragma once

#include <limits>

#include "common/program/stop_signal.hpp"
#include "device_bridge/bridge_config.hpp"
#include "device_bridge/bridge_report.hpp"
#include "device_bridge/link/client_settings.hpp"

namespace irdm {

/// How a bridge of this configuration connects. Throws Error about its key file.
/// @param config with a server
ClientSettings client_settings(const BridgeConfig& config);

/// Runs a bridge until its devices have no more to play, `duration` of session time is over, a
/// signal comes, or the client gives up, which report.client.failure then tells. Throws Error when
/// it cannot start.
/// @param config with a server
/// @param duration [s], > 0
BridgeReport run_bridge(const BridgeConfig& config, StopSignal& stop_signal,
                        double duration = std::numeric_limits<double>::infinity());

}  // namespace irdm
