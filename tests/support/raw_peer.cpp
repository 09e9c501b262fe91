#include "tests/support/raw_peer.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <stdexcept>
#include <utility>

#include "tests/support/eventually.hpp"
#include "tests/support/loopback.hpp"

namespace irdm::test {
namespace {

bool readable(int descriptor) {
  pollfd entry{descriptor, POLLIN, 0};
  return ::poll(&entry, 1, kDeadlineMs) > 0;
}

}  // namespace

RawPeer RawPeer::connect(std::uint16_t port, int receive_buffer) {
  RawPeer peer(::socket(AF_INET, SOCK_STREAM, 0));
  if (receive_buffer > 0) {
    ::setsockopt(peer.descriptor_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
  }
  const sockaddr_in address = loopback(port);
  if (::connect(peer.descriptor_, reinterpret_cast<const sockaddr*>(&address), sizeof address) !=
      0) {
    throw std::runtime_error("cannot connect");
  }
  return peer;
}

RawPeer::RawPeer(RawPeer&& other) noexcept
    : session(other.session),
      sequence(other.sequence),
      descriptor_(std::exchange(other.descriptor_, -1)) {}

RawPeer::~RawPeer() {
  close();
}

void RawPeer::close() {
  if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
}

void RawPeer::end_sending() {
  ::shutdown(descriptor_, SHUT_WR);
}

void RawPeer::cut() {
  const linger none{1, 0};
  ::setsockopt(descriptor_, SOL_SOCKET, SO_LINGER, &none, sizeof none);
  close();
}

std::string RawPeer::name() const {
  sockaddr_in address{};
  socklen_t size = sizeof address;
  ::getsockname(descriptor_, reinterpret_cast<sockaddr*>(&address), &size);
  return "127.0.0.1:" + std::to_string(ntohs(address.sin_port));
}

bool RawPeer::send(std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = ::send(descriptor_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent < 0) return false;  // the test looks at what the other side does
    bytes = bytes.subspan(static_cast<std::size_t>(sent));
  }
  return true;
}

void RawPeer::send(const wire::Message& message) {
  send(wire::encode_frame(message, session, sequence++, 0).view());
}

bool RawPeer::fill() {
  if (!readable(descriptor_)) return false;
  buffer_.resize(65536);
  const ssize_t size = ::recv(descriptor_, buffer_.data(), buffer_.size(), 0);
  if (size <= 0) return false;
  rest_ = std::span<const std::uint8_t>(buffer_).first(static_cast<std::size_t>(size));
  return true;
}

std::optional<wire::Frame> RawPeer::receive() {
  for (;;) {
    std::optional<wire::Frame> frame = reader_.read(rest_);
    if (frame) {
      if (const auto* welcome = std::get_if<wire::Welcome>(&frame->message)) {
        session = welcome->session;
      }
      return frame;
    }
    if (!fill()) return std::nullopt;
  }
}

bool RawPeer::ends() {
  for (;;) {
    if (!readable(descriptor_)) return false;
    if (!fill()) return true;
  }
}

RawListener::RawListener() : descriptor_(::socket(AF_INET, SOCK_STREAM, 0)) {
  sockaddr_in address = loopback(0);
  socklen_t size = sizeof address;
  auto* generic = reinterpret_cast<sockaddr*>(&address);
  if (::bind(descriptor_, generic, size) != 0 || ::listen(descriptor_, 8) != 0 ||
      ::getsockname(descriptor_, generic, &size) != 0) {
    throw std::runtime_error("cannot listen");
  }
  port_ = ntohs(address.sin_port);
}

RawListener::~RawListener() {
  ::close(descriptor_);
}

RawPeer RawListener::accept() {
  if (!readable(descriptor_)) throw std::runtime_error("nobody connects");
  return RawPeer(::accept(descriptor_, nullptr, nullptr));
}

std::vector<std::uint8_t> frame_bytes(const wire::Message& message, std::uint32_t session) {
  const wire::FrameBytes frame = wire::encode_frame(message, session, 0, 0);
  return {frame.view().begin(), frame.view().end()};
}

}  // namespace irdm::test
