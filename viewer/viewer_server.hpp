#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "viewer/page_files.hpp"
#include "viewer/viewer_session.hpp"

namespace irdm::viewer {

struct ViewerSettings {
  std::string address = "127.0.0.1";  ///< numeric IPv4 or IPv6 address of this machine
  std::uint16_t port = 0;             ///< 0: any free one
  std::string token = {};             ///< needed off the loopback address
  std::string onlooker_token = {};    ///< for viewers that may only look on
  PageFiles page = {};
  std::size_t max_viewers = 16;      ///< that watch: those that said nothing yet do not count
  std::size_t max_connections = 64;  ///< beyond, the one that is silent for the longest time ends
  int hello_timeout_ms = 5000;       ///< from WebSocket to Hello
  int idle_timeout_ms = 20'000;      ///< without a sign of life from a viewer
  int request_timeout_ms = 10'000;   ///< for an HTTP request, and to take its answer
  int health_period_ms = 500;
  int stylus_timeout_ms = 250;  ///< in which the viewer that holds the stylus has to say so again
};

/// Serves the page over HTTP and the live view over WebSocket (docs/viewer-protocol.md), on a
/// thread of its own under normal scheduling. Waits for nobody.
class ViewerServer {
 public:
  /// Binds and listens. Throws Error when it cannot, or when a token is needed and not there.
  /// @param run must outlive the server
  ViewerServer(ViewerSettings settings, ViewerSession& run);
  ViewerServer(const ViewerServer&) = delete;
  ViewerServer& operator=(const ViewerServer&) = delete;
  ~ViewerServer();  ///< stops

  /// Where a browser finds it, as http://ADDRESS:PORT, one or more; and the port alone.
  std::vector<std::string> urls() const;
  std::uint16_t port() const noexcept;
  /// Viewers that have shown the right token; any thread.
  std::uint32_t viewers() const noexcept;
  /// Complaints about peers beyond what is logged; any thread.
  std::uint64_t unlogged() const noexcept;

  void start();
  /// Sends what waits, says goodbye to every viewer, at most for half a second, and joins the
  /// thread. Further calls do nothing.
  void stop();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace irdm::viewer
