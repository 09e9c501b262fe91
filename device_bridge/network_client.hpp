#pragma once

#include <memory>

#include "common/realtime/event_fd.hpp"
#include "device_bridge/link/client_report.hpp"
#include "device_bridge/link/client_settings.hpp"
#include "device_bridge/servo_link.hpp"

namespace irdm {

/// Connects to the server, and again whenever the connection is lost, and relays samples and
/// forces, on a thread of its own. It gives up when the server refuses for a reason that will not
/// pass (another version, more styluses than it has, lockstep with a real device), and when a
/// lockstep session is lost.
class NetworkClient {
 public:
  /// Resolves the server's name. Throws Error when it cannot.
  /// @param gave_up signalled when it gives up
  NetworkClient(ServoLink& link, const ClientSettings& settings, EventFd& gave_up);
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
