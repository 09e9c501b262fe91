#include "device_bridge/haply/service_socket.hpp"

#include <chrono>
#include <utility>

#include "device_bridge/haply/http_request.hpp"

namespace irdm::haply {
namespace {

namespace beast = boost::beast;
namespace websocket = boost::beast::websocket;

constexpr std::chrono::seconds kPatience(2);
constexpr std::size_t kLongestMessage = std::size_t{1} << 20;

}  // namespace

ServiceSocket::ServiceSocket(boost::asio::io_context& io, const ServerAddress& address,
                             Listener listener)
    : address_(address), listener_(std::move(listener)), resolver_(io), stream_(io) {}

void ServiceSocket::open() {
  const auto self = shared_from_this();
  resolver_.async_resolve(
      address_.host, std::to_string(address_.port), [self](ErrorCode error, const auto& found) {
        if (!self->good(error)) return;
        beast::get_lowest_layer(self->stream_).expires_after(kPatience);
        beast::get_lowest_layer(self->stream_).async_connect(found, [self](ErrorCode e, auto&&) {
          if (self->good(e)) self->shake_hands();
        });
      });
}

void ServiceSocket::shake_hands() {
  beast::get_lowest_layer(stream_).expires_never();
  ErrorCode ignored;
  beast::get_lowest_layer(stream_).socket().set_option(boost::asio::ip::tcp::no_delay(true),
                                                       ignored);
  stream_.set_option(
      websocket::stream_base::timeout{kPatience, websocket::stream_base::none(), false});
  stream_.read_message_max(kLongestMessage);
  stream_.text(true);
  stream_.async_handshake(host_text(address_), "/", [self = shared_from_this()](ErrorCode error) {
    if (self->good(error)) self->read();
  });
}

void ServiceSocket::read() {
  stream_.async_read(buffer_, [self = shared_from_this()](ErrorCode error, std::size_t) {
    if (!self->good(error)) return;
    std::string text = beast::buffers_to_string(self->buffer_.cdata());
    self->buffer_.consume(self->buffer_.size());
    if (self->listens_) self->listener_.message(std::move(text));
    if (self->listens_) self->read();
  });
}

void ServiceSocket::write(std::string text) {
  text_ = std::move(text);
  writing_ = true;
  stream_.async_write(boost::asio::buffer(text_),
                      [self = shared_from_this()](ErrorCode error, std::size_t) {
                        self->writing_ = false;
                        self->good(error);
                      });
}

boost::asio::ip::address ServiceSocket::peer() const noexcept {
  ErrorCode ignored;
  return beast::get_lowest_layer(stream_).socket().remote_endpoint(ignored).address();
}

void ServiceSocket::leave(std::function<void()> done) {
  listens_ = false;
  stream_.async_close(websocket::close_code::normal,
                      [self = shared_from_this(), done = std::move(done)](ErrorCode) { done(); });
}

void ServiceSocket::drop() noexcept {
  listens_ = false;
  resolver_.cancel();
  beast::get_lowest_layer(stream_).close();
}

bool ServiceSocket::good(ErrorCode error) {
  if (!error) return listens_;
  if (std::exchange(listens_, false)) listener_.lost(error.message());
  return false;
}

}  // namespace irdm::haply
