#pragma once

#include <cstdint>
#include <memory>

#include "common/wire/asio.hpp"
#include "viewer/viewer_server.hpp"

namespace irdm::viewer {

/// Bytes that several viewers are sent.
using SharedBytes = std::shared_ptr<const Bytes>;

class Connection;

/// What a connection needs of the server that it belongs to. Viewer's thread.
class Hub {
 public:
  virtual ~Hub() = default;
  virtual const ViewerSettings& settings() const = 0;
  /// Of the scene, as many as settings have to be for.
  virtual std::size_t objects() const = 0;
  /// Whether one more viewer may watch.
  virtual bool has_room() const = 0;
  virtual SharedBytes scene() = 0;
  virtual SharedBytes newest_frame() = 0;
  virtual SharedBytes newest_health() = 0;
  virtual SharedBytes newest_state(const Connection& viewer) = 0;
  /// What a viewer asks for that may ask.
  virtual void handle(const Command& command) = 0;
  virtual void handle(const SettingsRequest& request) = 0;
  virtual void handle(const StylusRequest& request, const Connection& viewer) = 0;
  virtual void handle(const SceneRequest& request) = 0;
  /// Logs what a peer did wrong, or counts it where the log has had enough of them.
  virtual void complain(const std::string& what) = 0;
};

/// One connection from accept to close: HTTP requests, and perhaps a WebSocket in the end. It keeps
/// itself alive as long as anything is under way. Viewer's thread only.
class Connection {
 public:
  virtual ~Connection() = default;
  virtual void start() = 0;
  /// When it was accepted, last asked for something over HTTP, or became a WebSocket, whichever was
  /// last; monotonic [ns]. Of those that do not watch, the one that has said nothing for the
  /// longest time makes room for others.
  virtual std::int64_t heard_ns() const = 0;
  /// Its Hello was right.
  virtual bool watching() const = 0;
  /// It may not ask for anything.
  virtual bool looks_on() const = 0;
  /// Newest wins: takes the place of the one that still waits.
  virtual void offer_frame(SharedBytes frame) = 0;
  virtual void offer_health(SharedBytes health) = 0;
  virtual void offer_state(SharedBytes state) = 0;
  /// Applies the time limit for Hello.
  virtual void check_time(std::int64_t now_ns) = 0;
  /// Sends what waits and says goodbye.
  virtual void finish() = 0;
  /// Ends it at once.
  virtual void abort() = 0;
};

/// @param hub must outlive the connection
std::shared_ptr<Connection> make_connection(boost::asio::ip::tcp::socket socket, Hub& hub);

}  // namespace irdm::viewer
