#pragma once

// Must come before Boost's own headers: it mends Boost 1.74 under C++20.
#include "common/wire/asio.hpp"

#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "device_bridge/bridge_config.hpp"
#include "viewer/message.hpp"

namespace irdm::ros {

/// An onlooker at a server's viewer port (docs/viewer-protocol.md), in a thread of its own. A lost
/// connection is made again.
class ViewerClient {
 public:
  /// What is done with a message; called by its thread.
  struct Listener {
    std::function<void(const viewer::Scene&)> scene;  ///< first of each connection
    std::function<void(const SurfaceFrame&)> frame;   ///< has the scene's objects
  };

  /// @param token the server's viewer.onlooker_token, or viewer.token; empty: it has none
  ViewerClient(const ServerAddress& address, const std::string& token, Listener listener);
  ViewerClient(const ViewerClient&) = delete;
  ViewerClient& operator=(const ViewerClient&) = delete;
  ~ViewerClient();

 private:
  using Socket = boost::beast::websocket::stream<boost::beast::tcp_stream>;
  using ErrorCode = boost::beast::error_code;

  void connect();
  void shake_hands();
  void say_hello();
  void read();
  void take(const viewer::Bytes& bytes);
  /// False when there is an error: it is logged, and the next attempt is on its way.
  bool good(ErrorCode error);
  void try_again(const std::string& cause);

  const ServerAddress address_;
  const std::string host_;  ///< with the port, as in a URL
  const viewer::Bytes hello_;
  const Listener listener_;
  std::vector<std::size_t> nodes_;  ///< of each object
  std::string logged_;              ///< why there is no connection
  boost::asio::io_context io_;
  boost::asio::ip::tcp::resolver resolver_{io_};
  boost::asio::steady_timer pause_{io_};
  boost::beast::flat_buffer buffer_;
  std::optional<Socket> socket_;
  std::thread thread_;
};

}  // namespace irdm::ros
