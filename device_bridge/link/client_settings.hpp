#pragma once

#include <string>

#include "common/realtime/scheduling.hpp"
#include "device_bridge/bridge_config.hpp"

namespace irdm {

struct ClientSettings {
  ServerAddress server = {};
  std::string name = "irdm-bridge";  ///< for the server's log
  bool lockstep = true;              ///< whether all devices can run on the simulated clock
  bool predict = true;               ///< whether it wants to solve the contact itself
  int connect_timeout_ms = 100;      ///< of one attempt
  int back_off_ms = 50;              ///< between attempts
  int answer_timeout_ms = 1000;      ///< from Hello to Welcome
  RealTimeScheduling scheduling = RealTimeScheduling::kIgnore;
  int silence_timeout_ms = 2000;  ///< without a force; real time only
};

}  // namespace irdm
