#include "common/wire/datagram_socket.hpp"

#include <utility>

namespace irdm::wire {

DatagramLink::DatagramLink(std::shared_ptr<DatagramSocket> socket,
                           const DatagramSocket::Endpoint& peer, const DatagramKeys& keys,
                           DatagramEnd end, std::uint32_t session)
    : socket_(std::move(socket)), peer_(peer), end_(end), channel_(keys, end, session) {}

DatagramVerdict DatagramLink::receive(std::span<const std::uint8_t> datagram,
                                      const DatagramSocket::Endpoint& from) {
  if (from.address() != peer_.address()) return DatagramVerdict::kForeign;
  const DatagramChannel::Opened opened = channel_.open(datagram);
  if (opened.verdict != DatagramVerdict::kOpened) return opened.verdict;
  if (opened.newest) peer_.port(from.port());
  if (is_probe(opened.text)) {
    if (end_ == DatagramEnd::kServer) {
      probe();
    } else {
      established_ = true;
    }
    return DatagramVerdict::kOpened;
  }
  frame_ = assembly_.take(opened.number, opened.text);
  established_ = true;
  return frame_ ? DatagramVerdict::kMessage : DatagramVerdict::kOpened;
}

void DatagramLink::send(std::span<const std::uint8_t> frame) noexcept {
  const std::size_t count = part_count(frame);
  for (std::size_t part = 0; part < count; ++part) send_text(part_text(frame, part).view());
}

void DatagramLink::probe() noexcept {
  send_text(probe_text().view());
}

void DatagramLink::send_text(std::span<const std::uint8_t> text) noexcept {
  const std::span<const std::uint8_t> datagram = channel_.seal(text);
  if (datagram.empty() || peer_.port() == 0 || !socket_->send(datagram, peer_)) ++unsent_;
}

using boost::asio::ip::udp;
using boost::system::error_code;

namespace {

constexpr int kDatagramSendBuffer = 65536;
constexpr int kAtOnce = 64;  // then it is others' turn

}  // namespace

DatagramSocket::DatagramSocket(const boost::asio::any_io_executor& executor, const Endpoint& local)
    : socket_(executor, local) {
  error_code ignored;
  socket_.set_option(udp::socket::send_buffer_size(kDatagramSendBuffer), ignored);
  socket_.non_blocking(true);
}

void DatagramSocket::start(Received received) {
  received_ = std::move(received);
  wait();
}

void DatagramSocket::wait() {
  socket_.async_wait(udp::socket::wait_read, [self = shared_from_this()](const error_code& error) {
    if (error || !self->open_) return;
    self->receive();
    if (self->open_) self->wait();
  });
}

// An error is word of a datagram that was sent and did not arrive: nothing to do about it.
void DatagramSocket::receive() {
  for (int i = 0; i < kAtOnce && open_; ++i) {
    Endpoint from;
    error_code error;
    const std::size_t size = socket_.receive_from(boost::asio::buffer(incoming_), from, 0, error);
    if (error) return;
    received_({incoming_.data(), size}, from);
  }
}

bool DatagramSocket::send(std::span<const std::uint8_t> datagram, const Endpoint& to) noexcept {
  if (!open_) return false;
  error_code error;
  socket_.send_to(boost::asio::buffer(datagram.data(), datagram.size()), to, 0, error);
  return !error;
}

void DatagramSocket::close() noexcept {
  open_ = false;
  error_code ignored;
  socket_.close(ignored);
}

}  // namespace irdm::wire
