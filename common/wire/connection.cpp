#include "common/wire/connection.hpp"

#include <netinet/tcp.h>

#include <sstream>
#include <string_view>
#include <utility>

#include "common/realtime/clock.hpp"
#include "common/wire/protocol_error.hpp"
#include "common/wire/tls.hpp"

namespace irdm::wire {

using boost::asio::ip::tcp;
using boost::system::error_code;

namespace {

// What the kernel has queued cannot be replaced by something newer. The buffer holds what is under
// way as well; of what has not been sent once, the kernel takes little [bytes].
constexpr int kSendBuffer = 65536;
constexpr int kNotSent = 2048;
using NotSentLimit = boost::asio::detail::socket_option::integer<IPPROTO_TCP, TCP_NOTSENT_LOWAT>;
// The label that TLS's exporter wants (RFC 8446, section 7.5).
constexpr std::string_view kDatagramLabel = "EXPERIMENTAL irdm datagrams";

}  // namespace

Connection::Connection(std::unique_ptr<Stream> stream, FrameTap* tap,
                       const std::optional<tcp::endpoint>& remote)
    : stream_(std::move(stream)), tap_(tap) {
  tcp::socket& socket = stream_->socket();
  error_code ignored;
  socket.set_option(tcp::no_delay(true), ignored);
  socket.set_option(tcp::socket::send_buffer_size(kSendBuffer), ignored);
  socket.set_option(NotSentLimit(kNotSent), ignored);
  remote_ = remote ? *remote : socket.remote_endpoint(ignored);
  std::ostringstream name;
  name << remote_;
  peer_ = name.str();
  if (tap_ != nullptr) number_ = tap_->open(peer_);
}

void Connection::start(Handlers handlers) {
  handlers_ = std::move(handlers);
  received_ns_ = monotonic_ns();
  stream_->handshake(
      [self = shared_from_this()](const error_code& error) { self->on_handshake(error); });
}

void Connection::on_handshake(const error_code& error) {
  if (!open_) return;
  refused_ = is_tls_failure(error);
  if (error) return close(error.message());
  ready_ = true;
  read();
  write();
}

void Connection::read() {
  stream_->read_some(boost::asio::buffer(incoming_),
                     [self = shared_from_this()](const error_code& error, std::size_t size) {
                       if (!self->open_) return;
                       if (error) return self->close(error.message());
                       self->received_ns_ = monotonic_ns();
                       self->take({self->incoming_.data(), size});
                       if (self->open_) self->read();
                     });
}

void Connection::take(std::span<const std::uint8_t> bytes) {
  try {
    while (open_ && !finishing_) {
      const std::optional<Frame> frame = reader_.read(bytes);
      if (!frame) break;
      partial_since_ns_.reset();
      tell(TapKind::kReceived, reader_.bytes());
      check_order(frame->header.sequence);
      hand_on(*frame);
    }
  } catch (const ProtocolError& error) {
    if (reader_.partial()) tell(TapKind::kSpoilt, reader_.bytes());
    if (open_ && !finishing_) handlers_.violated(error);
  }
  if (finishing_ || !reader_.partial()) {
    partial_since_ns_.reset();
  } else if (!partial_since_ns_) {
    partial_since_ns_ = received_ns_;
  }
}

void Connection::check_order(std::uint64_t sequence) {
  if (received_sequence_ && sequence <= *received_sequence_) {
    throw ProtocolError(ProtocolFault::kBackward, "frame " + std::to_string(sequence) +
                                                      " after frame " +
                                                      std::to_string(*received_sequence_));
  }
  received_sequence_ = sequence;
}

// What went by TCP may be overtaken by a datagram.
void Connection::hand_on(const Frame& frame) {
  if (order_.take(frame)) return handlers_.received(frame);
  ++late_;
}

DatagramKeys Connection::derive_keys(const KeyMaterial& random) const {
  return keys_of(stream_->derive(kDatagramLabel, random));
}

tcp::endpoint Connection::local_endpoint() const {
  error_code ignored;
  return stream_->socket().local_endpoint(ignored);
}

void Connection::probe() noexcept {
  if (open_ && !finishing_ && datagrams_) datagrams_->probe();
}

DatagramVerdict Connection::take_datagram(std::span<const std::uint8_t> datagram,
                                          const DatagramSocket::Endpoint& from) {
  if (!open_ || finishing_ || !datagrams_) return DatagramVerdict::kForeign;
  try {
    const DatagramVerdict verdict = datagrams_->receive(datagram, from);
    const bool message = verdict == DatagramVerdict::kMessage;
    if (message || verdict == DatagramVerdict::kOpened) received_ns_ = monotonic_ns();
    if (message) tell(TapKind::kReceived, datagrams_->bytes());
    if (message) hand_on(datagrams_->frame());
    return verdict;
  } catch (const ProtocolError& error) {
    if (open_ && !finishing_) handlers_.violated(error);
    return DatagramVerdict::kOpened;
  }
}

void Connection::tell_violation(const ProtocolError& error) noexcept {
  tell(TapKind::kViolation, error.what());
}

void Connection::tell(TapKind kind, std::span<const std::uint8_t> bytes) noexcept {
  if (tap_ != nullptr) tap_->see(kind, number_, bytes);
}

void Connection::tell(TapKind kind, std::string_view text) noexcept {
  tell(kind, std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

void Connection::append(const Message& message) {
  const FrameBytes frame = encode_frame(message, session_, sequence_++, monotonic_ns());
  tell(TapKind::kSent, frame.view());
  writing_.insert(writing_.end(), frame.view().begin(), frame.view().end());
}

void Connection::send(const Message& message) {
  if (!open_ || finishing_) return;
  control_.push_back(message);
  write();
}

bool Connection::send_newest(std::size_t stream, const Message& message) {
  if (!open_ || finishing_) return false;
  if (newest_.size() <= stream) newest_.resize(stream + 1);
  const bool replaces = newest_[stream].has_value();
  if (by_datagrams() && is_of_stream(message)) {
    newest_[stream].reset();
    const FrameBytes frame = encode_frame(message, session_, sequence_++, monotonic_ns());
    tell(TapKind::kSent, frame.view());
    datagrams_->send(frame.view());
    return replaces;
  }
  newest_[stream] = message;
  write();
  return replaces;
}

void Connection::write() {
  if (!open_ || !ready_ || writing_since_ns_) return;
  writing_.clear();
  for (std::optional<Message>& message : newest_) {
    if (message) append(*message);
    message.reset();
  }
  for (const Message& message : control_) append(message);
  control_.clear();
  if (writing_.empty()) {
    error_code ignored;
    if (finishing_) stream_->socket().shutdown(tcp::socket::shutdown_send, ignored);
    return;
  }
  writing_since_ns_ = monotonic_ns();
  stream_->write(boost::asio::buffer(writing_),
                 [self = shared_from_this()](const error_code& error) {
                   self->writing_since_ns_.reset();
                   if (!self->open_) return;
                   if (error) return self->close(error.message());
                   self->write();
                 });
}

void Connection::finish() {
  if (!open_ || finishing_) return;
  finishing_ = true;
  if (!ready_) return close("ended before the handshake");
  write();
}

void Connection::drop(const std::string& reason) {
  error_code ignored;
  stream_->socket().set_option(tcp::socket::linger(true, 0), ignored);
  close(reason);
}

void Connection::close(const std::string& reason) {
  if (!open_) return;
  open_ = false;
  error_code ignored;
  stream_->socket().close(ignored);
  tell(TapKind::kClosed, reason);
  if (handlers_.closed) handlers_.closed(reason);
}

}  // namespace irdm::wire
