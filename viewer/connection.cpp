// Must come before Boost's own headers: it mends Boost 1.74 under C++20.
#include "common/wire/asio.hpp"

#include "viewer/connection.hpp"

#include <array>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <optional>
#include <string>

#include "common/realtime/clock.hpp"
#include "viewer/request_rules.hpp"

namespace irdm::viewer {
namespace {

namespace beast = boost::beast;
namespace http = boost::beast::http;
namespace websocket = boost::beast::websocket;
using beast::error_code;
using Request = http::request<http::empty_body>;
using Response = http::response<http::span_body<const char>>;
using Socket = websocket::stream<beast::tcp_stream, false>;  // without compression

constexpr char kLivePath[] = "/live";
constexpr std::size_t kHeaderLimit = 8192;
constexpr std::size_t kMessageLimit = 2048;  // settings of kMaxObjects take 1320
constexpr std::size_t kDrainLimit = 1 << 20;
constexpr std::chrono::seconds kDrainTime(1);
constexpr int kSendBuffer = 256 * 1024;  // what the kernel may hold for a viewer that is slow

std::string_view view(beast::string_view text) {
  return {text.data(), text.size()};
}

void set_security(Response& response) {
  response.set("Content-Security-Policy",
               "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: "
               "blob:; connect-src 'self'; base-uri 'none'; form-action 'none'; "
               "frame-ancestors 'none'");
  response.set("X-Content-Type-Options", "nosniff");
  response.set("Referrer-Policy", "no-referrer");
  response.set("Cross-Origin-Opener-Policy", "same-origin");
  response.set("Cross-Origin-Resource-Policy", "same-origin");
}

// Returns why the header is refused; null: it is not. Proxies and servers that take different ones
// of two fields can be played off against each other (RFC 9112, section 3.2).
const char* fault_of(const Request& request) {
  constexpr unsigned kVersion11 = 11;
  const std::size_t hosts = request.count(http::field::host);
  if (hosts > 1) return "more than one Host\n";
  if (hosts == 0 && request.version() >= kVersion11) return "no Host\n";
  if (request.count(http::field::origin) > 1) return "more than one Origin\n";
  return nullptr;
}

class BeastConnection final : public Connection,
                              public std::enable_shared_from_this<BeastConnection> {
 public:
  BeastConnection(boost::asio::ip::tcp::socket socket, Hub& hub)
      : hub_(hub), stream_(std::move(socket)) {
    error_code ignored;
    stream_.socket().set_option(boost::asio::ip::tcp::no_delay(true), ignored);
    stream_.socket().set_option(boost::asio::socket_base::send_buffer_size(kSendBuffer), ignored);
  }

  void start() override { read_request(); }
  std::int64_t heard_ns() const override { return heard_ns_; }
  bool watching() const override { return watching_ && !closing_; }
  bool looks_on() const override { return looks_on_; }
  void offer_frame(SharedBytes frame) override { offer(frame_, std::move(frame)); }
  void offer_health(SharedBytes health) override { offer(health_, std::move(health)); }
  void offer_state(SharedBytes state) override { offer(state_, std::move(state)); }
  void check_time(std::int64_t now_ns) override;
  void finish() override;
  void abort() override;

 private:
  // HTTP
  void read_request();
  void take_request(error_code error);
  void answer(const Request& request);
  void answer_failure(http::status status, const std::string& text, const Request& request = {});
  void write_response();
  void drain();
  // WebSocket
  void open_socket(const Request& request);
  void read_message();
  void take_message();
  void take(const Hello& hello);
  void take(const Command& command);
  void take(const SettingsRequest& request);
  void take(const StylusRequest& request);
  void take(const SceneRequest& request);
  void expect_hello() const;
  void offer(SharedBytes& slot, SharedBytes bytes);
  void write_next();
  void close(websocket::close_code code, const char* reason);

  Hub& hub_;
  beast::tcp_stream stream_;  ///< until it becomes a WebSocket
  beast::flat_buffer buffer_{kHeaderLimit};
  std::optional<http::request_parser<http::empty_body>> parser_;
  Response response_;
  std::string text_;  ///< body of a response that is no file
  std::array<char, 4096> waste_;
  std::size_t wasted_ = 0;
  std::int64_t heard_ns_ = monotonic_ns();

  std::optional<Socket> socket_;
  bool accepted_ = false;
  bool watching_ = false;
  bool looks_on_ = false;
  bool closing_ = false;
  bool finishing_ = false;
  SharedBytes scene_;  ///< these four wait to be sent
  SharedBytes state_;
  SharedBytes frame_;
  SharedBytes health_;
  SharedBytes sending_;
};

// HTTP

void BeastConnection::read_request() {
  parser_.emplace();
  parser_->header_limit(kHeaderLimit);
  parser_->body_limit(0);
  stream_.expires_after(std::chrono::milliseconds(hub_.settings().request_timeout_ms));
  http::async_read_header(
      stream_, buffer_, *parser_,
      [self = shared_from_this()](error_code error, std::size_t) { self->take_request(error); });
}

void BeastConnection::take_request(error_code error) {
  if (error == http::error::header_limit || error == http::error::buffer_overflow) {
    return answer_failure(http::status::request_header_fields_too_large, "too long a header\n");
  }
  if (error == http::error::body_limit) {
    return answer_failure(http::status::payload_too_large, "no body is taken\n");
  }
  if (error && error.category() == http::make_error_code(http::error::end_of_stream).category() &&
      error != http::error::end_of_stream && error != http::error::partial_message) {
    return answer_failure(http::status::bad_request, "not HTTP\n");
  }
  if (error) return abort();
  heard_ns_ = monotonic_ns();
  const Request request = parser_->get();
  if (const char* fault = fault_of(request)) {
    return answer_failure(http::status::bad_request, fault, request);
  }
  if (request.count(http::field::transfer_encoding) > 0 && !parser_->chunked()) {
    return answer_failure(http::status::not_implemented, "an unknown transfer coding\n", request);
  }
  const bool has_body = parser_->chunked() || parser_->content_length().value_or(0) > 0;
  if (request.method() != http::verb::get && request.method() != http::verb::head) {
    return answer_failure(http::status::method_not_allowed, "only GET and HEAD\n");
  }
  if (has_body) return answer_failure(http::status::payload_too_large, "no body is taken\n");
  if (view(request.target()) == kLivePath) return open_socket(request);
  answer(request);
}

void BeastConnection::answer(const Request& request) {
  const PageFiles& page = hub_.settings().page;
  const PageFile* file = page.find(view(request.target()));
  if (file == nullptr) {
    return answer_failure(http::status::not_found,
                          page.empty() ? "The viewer's page was not built: run scripts/setup.sh "
                                         "and build again.\n"
                                       : "There is no such page.\n",
                          request);
  }
  response_ = Response(http::status::ok, request.version());
  set_security(response_);
  response_.set(http::field::content_type, file->type);
  response_.set(http::field::etag, file->etag);
  response_.set(http::field::vary, "Accept-Encoding");
  response_.set(http::field::cache_control,
                file->immutable ? "public, max-age=31536000, immutable" : "no-cache");
  response_.keep_alive(request.keep_alive());
  if (names_etag(view(request[http::field::if_none_match]), file->etag)) {
    response_.result(http::status::not_modified);
    return write_response();
  }
  const bool packed =
      !file->packed.empty() && accepts_gzip(view(request[http::field::accept_encoding]));
  const std::string& body = packed ? file->packed : file->body;
  if (packed) response_.set(http::field::content_encoding, "gzip");
  response_.content_length(body.size());
  if (request.method() == http::verb::get) response_.body() = {body.data(), body.size()};
  write_response();
}

void BeastConnection::answer_failure(http::status status, const std::string& text,
                                     const Request& request) {
  text_ = text;
  response_ = Response(status, 11);
  set_security(response_);
  response_.set(http::field::content_type, "text/plain; charset=utf-8");
  response_.set(http::field::cache_control, "no-store");
  if (status == http::status::method_not_allowed) response_.set(http::field::allow, "GET, HEAD");
  response_.content_length(text_.size());
  if (request.method() != http::verb::head) response_.body() = {text_.data(), text_.size()};
  response_.keep_alive(false);
  write_response();
}

void BeastConnection::write_response() {
  stream_.expires_after(std::chrono::milliseconds(hub_.settings().request_timeout_ms));
  const auto done = [self = shared_from_this()](error_code error, std::size_t) {
    if (error) return self->abort();
    if (self->response_.keep_alive() && !self->finishing_) return self->read_request();
    self->drain();
  };
  http::async_write(stream_, response_, done);
}

// What the other side still sends is thrown away, at least for a moment: a socket that is closed
// with unread bytes takes the answer back.
void BeastConnection::drain() {
  if (wasted_ == 0) {
    error_code ignored;
    stream_.socket().shutdown(boost::asio::ip::tcp::socket::shutdown_send, ignored);
    stream_.expires_after(kDrainTime);
  }
  stream_.async_read_some(boost::asio::buffer(waste_),
                          [self = shared_from_this()](error_code error, std::size_t count) {
                            self->wasted_ += std::max<std::size_t>(count, 1);
                            if (error || self->wasted_ > kDrainLimit) return self->abort();
                            self->drain();
                          });
}

// WebSocket

void BeastConnection::open_socket(const Request& request) {
  if (!websocket::is_upgrade(request)) {
    return answer_failure(http::status::upgrade_required, "only for WebSockets\n", request);
  }
  if (!origin_allowed(view(request[http::field::origin]), view(request[http::field::host]),
                      !hub_.settings().token.empty())) {
    hub_.complain("refused a page of another origin");
    return answer_failure(http::status::forbidden, "another origin\n", request);
  }
  if (!hub_.has_room()) {
    hub_.complain("refused one viewer too many");
    return answer_failure(http::status::service_unavailable, "too many viewers\n", request);
  }
  stream_.expires_never();
  socket_.emplace(std::move(stream_));
  websocket::stream_base::timeout limits;
  limits.handshake_timeout = std::chrono::milliseconds(hub_.settings().hello_timeout_ms);
  limits.idle_timeout = std::chrono::milliseconds(hub_.settings().idle_timeout_ms);
  limits.keep_alive_pings = true;
  socket_->set_option(limits);
  socket_->read_message_max(kMessageLimit);
  socket_->auto_fragment(false);
  socket_->binary(true);
  socket_->async_accept(request, [self = shared_from_this()](error_code error) {
    if (error || self->finishing_) return self->abort();
    self->accepted_ = true;
    self->buffer_.clear();
    self->read_message();
  });
}

void BeastConnection::read_message() {
  socket_->async_read(buffer_, [self = shared_from_this()](error_code error, std::size_t) {
    // Beast has answered a message that is too long, or no WebSocket message, itself.
    if (error) return self->abort();
    self->take_message();
  });
}

void BeastConnection::take_message() {
  try {
    if (!socket_->got_binary()) throw MessageError("it is text");
    const auto data = buffer_.cdata();
    const ClientMessage message =
        decode_client({static_cast<const std::uint8_t*>(data.data()), data.size()});
    buffer_.clear();
    std::visit([this](const auto& content) { take(content); }, message);
  } catch (const MessageError& error) {
    hub_.complain(std::string("a message is wrong: ") + error.what() + "; connection closed");
    close(websocket::close_code::protocol_error, "wrong message");
  }
  if (!closing_) read_message();
}

void BeastConnection::take(const Hello& hello) {
  if (watching_) throw MessageError("it is a second Hello");
  const std::string& token = hub_.settings().token;
  const std::string& onlooker_token = hub_.settings().onlooker_token;
  const bool full = token.empty() || same_token(hello.token, token);
  const bool onlooker = !onlooker_token.empty() && same_token(hello.token, onlooker_token);
  if (!full && !onlooker) {
    hub_.complain("wrong token; connection closed");
    return close(websocket::close_code::policy_error, "wrong token");
  }
  if (!hub_.has_room()) {
    hub_.complain("refused one viewer too many");
    return close(websocket::close_code::try_again_later, "too many viewers");
  }
  watching_ = true;
  looks_on_ = !full || hello.looks_on;
  scene_ = hub_.scene();
  state_ = hub_.newest_state(*this);
  frame_ = hub_.newest_frame();
  health_ = hub_.newest_health();
  write_next();
}

void BeastConnection::expect_hello() const {
  if (!watching_) throw MessageError("it comes before Hello");
}

void BeastConnection::take(const Command& command) {
  expect_hello();
  if (!looks_on_) hub_.handle(command);
}

void BeastConnection::take(const SettingsRequest& request) {
  expect_hello();
  if (request.objects != hub_.objects()) {
    throw MessageError("its settings are for another number of objects");
  }
  if (!looks_on_) hub_.handle(request);
}

void BeastConnection::take(const StylusRequest& request) {
  expect_hello();
  if (!looks_on_) hub_.handle(request, *this);
}

void BeastConnection::take(const SceneRequest& request) {
  expect_hello();
  if (!looks_on_) hub_.handle(request);
}

void BeastConnection::offer(SharedBytes& slot, SharedBytes bytes) {
  slot = std::move(bytes);
  write_next();
}

void BeastConnection::write_next() {
  if (sending_ || closing_) return;
  for (SharedBytes* waiting : {&scene_, &state_, &health_, &frame_}) {
    if (!*waiting) continue;
    sending_ = std::exchange(*waiting, nullptr);
    socket_->async_write(boost::asio::buffer(*sending_),
                         [self = shared_from_this()](error_code error, std::size_t) {
                           self->sending_ = nullptr;
                           if (error) return self->abort();
                           self->write_next();
                         });
    return;
  }
  if (finishing_) close(websocket::close_code::going_away, "the server stops");
}

void BeastConnection::close(websocket::close_code code, const char* reason) {
  if (closing_) return;
  closing_ = true;
  socket_->async_close({code, reason}, [self = shared_from_this()](error_code) { self->abort(); });
}

void BeastConnection::check_time(std::int64_t now_ns) {
  const std::int64_t limit = hub_.settings().hello_timeout_ms * kNanosecondsPerMillisecond;
  if (socket_ && !watching_ && now_ns - heard_ns_ > limit) abort();
}

void BeastConnection::finish() {
  finishing_ = true;
  if (accepted_) return write_next();
  abort();
}

void BeastConnection::abort() {
  closing_ = true;
  error_code ignored;
  if (socket_) {
    beast::get_lowest_layer(*socket_).socket().close(ignored);
  } else {
    stream_.socket().close(ignored);
  }
}

}  // namespace

std::shared_ptr<Connection> make_connection(boost::asio::ip::tcp::socket socket, Hub& hub) {
  return std::make_shared<BeastConnection>(std::move(socket), hub);
}

}  // namespace irdm::viewer
