#pragma once

#include <optional>
#include <string>

#include "common/realtime/scheduling.hpp"
#include "common/wire/frame_tap.hpp"
#include "common/wire/secret_key.hpp"
#include "device_bridge/bridge_config.hpp"

namespace irdm {

struct ClientSettings {
  ServerAddress server = {};
  std::string name = "irdm-bridge";  ///< for the server's log
  bool lockstep = true;              ///< whether all devices can run on the simulated clock
  bool predict = true;               ///< whether it wants to solve the contact itself
  bool udp = false;                  ///< whether it wants the stream by datagrams
  int connect_timeout_ms = 75;       ///< of one attempt
  int back_off_ms = 20;              ///< from the begin of one attempt to the next, at least
  int refused_ms = 100;              ///< the same after a refusal that may pass
  int answer_timeout_ms = 150;       ///< from Hello to Welcome
  RealTimeScheduling scheduling = RealTimeScheduling::kIgnore;
  /// Without an answer to a newer sample; real time only. At least five steps of the server.
  int silence_timeout_ms = 100;
  /// The server's, for TLS; nothing: no TLS, and the server has to be on this machine.
  std::optional<wire::SecretKey> key = {};
  wire::FrameTap* tap = nullptr;  ///< listens in, in the network thread; null: nobody
};

}  // namespace irdm
