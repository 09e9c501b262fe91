#pragma once

#include <optional>

#include "device_bridge/bridge_config.hpp"
#include "device_bridge/doctor/judgements.hpp"

namespace irdm::doctor {

/// Looks at what a bridge needs: drivers, ports, permissions, clock, server. With a configuration
/// also at its devices, which are opened and closed, without force, and at its server.
Findings examine(const std::optional<BridgeConfig>& config);

}  // namespace irdm::doctor
