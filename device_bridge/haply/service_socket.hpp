#pragma once

// Must come before Boost's own headers: it mends Boost 1.74 under C++20.
#include "common/wire/asio.hpp"

#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <functional>
#include <memory>
#include <string>

#include "device_bridge/bridge_config.hpp"

namespace irdm::haply {

/// A WebSocket for text, as client. Used in the thread of its io_context alone.
class ServiceSocket : public std::enable_shared_from_this<ServiceSocket> {
 public:
  /// What is done with what comes.
  struct Listener {
    std::function<void(std::string)> message;
    std::function<void(const std::string& cause)> lost;  ///< nothing comes after it
  };

  ServiceSocket(boost::asio::io_context& io, const ServerAddress& address, Listener listener);

  /// Connects, and from then on reads.
  void open();
  /// One message at a time: not while writing().
  void write(std::string text);
  bool writing() const noexcept { return writing_; }
  /// Where the service is; while connected, else none in particular.
  boost::asio::ip::address peer() const noexcept;
  /// Says goodbye. @param done called when the service did, too, or is gone
  void leave(std::function<void()> done);
  /// Closes the connection without a word. From here on the listener is told nothing.
  void drop() noexcept;

 private:
  using ErrorCode = boost::beast::error_code;

  void shake_hands();
  void read();
  /// False when there is an error; the listener is told.
  bool good(ErrorCode error);

  const ServerAddress address_;
  Listener listener_;
  bool listens_ = true;
  bool writing_ = false;
  std::string text_;  ///< that is written
  boost::asio::ip::tcp::resolver resolver_;
  boost::beast::flat_buffer buffer_;
  boost::beast::websocket::stream<boost::beast::tcp_stream, false> stream_;  ///< no compression
};

}  // namespace irdm::haply
