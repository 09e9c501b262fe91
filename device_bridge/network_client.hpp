#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "common/realtime/histogram.hpp"
#include "common/realtime/scheduling.hpp"
#include "common/realtime/wakeup.hpp"
#include "device_bridge/bridge_config.hpp"
#include "device_bridge/servo_link.hpp"

namespace irdm {

struct ClientSettings {
  ServerAddress server = {};
  std::string name = "irdm-bridge";  ///< for the server's log
  bool lockstep = true;              ///< whether all devices can run on the simulated clock
  int connect_timeout_ms = 100;      ///< of one attempt
  int back_off_ms = 50;              ///< between attempts
  int answer_timeout_ms = 1000;      ///< from Hello to Welcome
  RealTimeScheduling scheduling = RealTimeScheduling::kIgnore;
  int silence_timeout_ms = 2000;  ///< without a force; real time only
};

struct ClientReport {
  std::uint64_t sessions = 0;
  std::uint64_t forces = 0;        ///< received and taken
  std::uint64_t forces_old = 0;    ///< dropped: not newer than the last, or of no sample of ours
  std::uint64_t gaps = 0;          ///< times that force steps are missing between two forces
  std::uint64_t steps_missed = 0;  ///< force steps missing in all gaps
  std::uint64_t longest_gap = 0;   ///< [steps]
  std::uint64_t samples = 0;       ///< given to a connection
  std::uint64_t protocol_errors = 0;
  Histogram round_trip;  ///< sample taken to its first force received [ns]; real time only
  std::string failure;   ///< why it gave up, one line; empty: it did not
};

/// Connects to the server, and again whenever the connection is lost, and relays samples and
/// forces, on a thread of its own. It gives up when the server refuses for a reason that will not
/// pass (another version, more styluses than it has, lockstep with a real device), and when a
/// lockstep session is lost.
class NetworkClient {
 public:
  /// Resolves the server's name. Throws Error when it cannot.
  /// @param gave_up signalled when it gives up
  NetworkClient(ServoLink& link, const ClientSettings& settings, Wakeup& gave_up);
  NetworkClient(const NetworkClient&) = delete;
  NetworkClient& operator=(const NetworkClient&) = delete;
  ~NetworkClient();  ///< stops

  void start();
  /// Says goodbye (finished, or else told to stop), waits at most half a second for the server to
  /// hang up, and joins the thread. Further calls do nothing.
  void stop(bool finished = false);
  /// After stop().
  const ClientReport& report() const noexcept;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace irdm
