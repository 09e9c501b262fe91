#pragma once

#include <cstdint>
#include <string>

#include "common/realtime/scheduling.hpp"
#include "device_bridge/bridge_config.hpp"

namespace irdm::haply {

struct InverseSettings {
  ServerAddress service = {"localhost", 10001};
  std::uint16_t old_http_port = 10000;  ///< where services before 3.5 take settings
  std::uint16_t events_port = 10020;    ///< where services from 3.5 on tell events
  std::string device = {};  ///< its id; empty: the first that this process has not opened
  std::string grip = {};    ///< likewise; empty: the first in a message
  bool shared = false;      ///< another session of the service may command it, too
  RealTimeScheduling scheduling = RealTimeScheduling::kIgnore;
};

}  // namespace irdm::haply
