#include "ros_bridge/viewer_client.hpp"

#include <spdlog/spdlog.h>

#include <chrono>
#include <exception>
#include <utility>

namespace irdm::ros {
namespace {

namespace beast = boost::beast;
namespace websocket = boost::beast::websocket;

constexpr std::chrono::seconds kPatience(5);  // the server sends twice a second
constexpr std::chrono::seconds kPause(1);
constexpr std::size_t kLongestMessage = std::size_t{1} << 28;

// Of docs/viewer-protocol.md.
constexpr std::size_t kTypeAt = 6;
constexpr std::uint8_t kScene = 1;
constexpr std::uint8_t kFrame = 2;

std::string in_url(const ServerAddress& address) {
  const bool numeric6 = address.host.find(':') != std::string::npos;
  return (numeric6 ? '[' + address.host + ']' : address.host) + ':' + std::to_string(address.port);
}

}  // namespace

ViewerClient::ViewerClient(const ServerAddress& address, const std::string& token,
                           Listener listener)
    : address_(address),
      host_(in_url(address)),
      hello_(viewer::encode(viewer::ClientMessage(viewer::Hello{token, true}))),
      listener_(std::move(listener)) {
  connect();
  thread_ = std::thread([this] { io_.run(); });
}

ViewerClient::~ViewerClient() {
  io_.stop();
  thread_.join();
}

void ViewerClient::connect() {
  socket_.emplace(io_);
  resolver_.async_resolve(
      address_.host, std::to_string(address_.port), [this](ErrorCode error, const auto& found) {
        if (!good(error)) return;
        beast::get_lowest_layer(*socket_).expires_after(kPatience);
        beast::get_lowest_layer(*socket_).async_connect(found, [this](ErrorCode failure, auto&&) {
          if (good(failure)) shake_hands();
        });
      });
}

void ViewerClient::shake_hands() {
  beast::get_lowest_layer(*socket_).expires_never();
  socket_->set_option(websocket::stream_base::timeout{kPatience, kPatience, false});
  socket_->set_option(websocket::stream_base::decorator([this](websocket::request_type& request) {
    request.set(beast::http::field::origin, "http://" + host_);
  }));
  socket_->read_message_max(kLongestMessage);
  socket_->binary(true);
  socket_->async_handshake(host_, "/live", [this](ErrorCode error) {
    if (good(error)) say_hello();
  });
}

void ViewerClient::say_hello() {
  nodes_.clear();
  socket_->async_write(boost::asio::buffer(hello_), [this](ErrorCode error, std::size_t) {
    if (good(error)) read();
  });
}

void ViewerClient::read() {
  buffer_.clear();
  socket_->async_read(buffer_, [this](ErrorCode error, std::size_t) {
    if (!good(error)) return;
    const auto data = boost::asio::buffer_cast<const std::uint8_t*>(buffer_.cdata());
    try {
      take(viewer::Bytes(data, data + buffer_.size()));
    } catch (const std::exception& wrong) {
      return try_again(std::string("a message is wrong: ") + wrong.what());
    }
    read();
  });
}

void ViewerClient::take(const viewer::Bytes& bytes) {
  if (bytes.size() <= kTypeAt) throw viewer::MessageError("it is too short");
  if (bytes[kTypeAt] == kScene) {
    const viewer::Scene scene = viewer::decode_scene(bytes);
    for (const viewer::SceneObject& object : scene.objects) {
      nodes_.push_back(static_cast<std::size_t>(object.rest.rows()));
    }
    logged_.clear();
    listener_.scene(scene);
  } else if (bytes[kTypeAt] == kFrame) {
    listener_.frame(viewer::decode_frame(bytes, nodes_));
  }
}

bool ViewerClient::good(ErrorCode error) {
  if (!error) return true;
  const bool refused = error == websocket::error::closed &&
                       socket_->reason().code == websocket::close_code::policy_error;
  try_again(refused ? "wrong token (--token-file, IRDM_TOKEN)" : error.message());
  return false;
}

void ViewerClient::try_again(const std::string& cause) {
  if (cause != logged_) spdlog::warn("viewer {}: {}; trying again", host_, cause);
  logged_ = cause;
  pause_.expires_after(kPause);
  pause_.async_wait([this](ErrorCode error) {
    if (!error) connect();
  });
}

}  // namespace irdm::ros
