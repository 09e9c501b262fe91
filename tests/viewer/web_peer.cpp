#include "tests/viewer/web_peer.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <stdexcept>
#include <utility>

#include "tests/support/eventually.hpp"

namespace irdm::test {

WebPeer::WebPeer(std::uint16_t port, int receive_buffer)
    : descriptor_(::socket(AF_INET, SOCK_STREAM, 0)), port_(port) {
  const timeval deadline{kDeadlineMs / 1000, 0};
  ::setsockopt(descriptor_, SOL_SOCKET, SO_RCVTIMEO, &deadline, sizeof deadline);
  if (receive_buffer > 0) {
    ::setsockopt(descriptor_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
  }
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::connect(descriptor_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    throw std::runtime_error("nobody listens on port " + std::to_string(port));
  }
}

WebPeer::WebPeer(WebPeer&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)),
      port_(other.port_),
      buffer_(std::move(other.buffer_)) {}

WebPeer::~WebPeer() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void WebPeer::send(const std::string& text) {
  // A server that has heard enough may have closed already: that is for the answer to tell.
  [[maybe_unused]] const ssize_t sent = ::send(descriptor_, text.data(), text.size(), MSG_NOSIGNAL);
}

void WebPeer::finish() {
  ::shutdown(descriptor_, SHUT_WR);
}

bool WebPeer::fill() {
  std::array<char, 65536> bytes;
  ssize_t count = 0;
  do {
    count = ::recv(descriptor_, bytes.data(), bytes.size(), 0);
  } while (count < 0 && errno == EINTR);  // a fuzzer has timers
  if (count > 0) buffer_.append(bytes.data(), static_cast<std::size_t>(count));
  return count > 0;
}

bool WebPeer::read_byte() {
  char byte = 0;
  if (::recv(descriptor_, &byte, 1, 0) != 1) return false;
  buffer_ += byte;
  return true;
}

bool WebPeer::have(std::size_t count) {
  while (buffer_.size() < count) {
    if (!fill()) return false;
  }
  return true;
}

std::optional<std::string> WebPeer::rest() {
  while (fill()) {
  }
  char byte = 0;
  if (::recv(descriptor_, &byte, 1, MSG_DONTWAIT) != 0) return std::nullopt;
  return std::exchange(buffer_, {});
}

std::string WebPeer::header() {
  std::size_t end = std::string::npos;
  while ((end = buffer_.find("\r\n\r\n")) == std::string::npos) {
    if (!fill()) throw std::runtime_error("no answer, but: " + buffer_);
  }
  const std::string header = buffer_.substr(0, end + 4);
  buffer_.erase(0, end + 4);
  return header;
}

std::string WebPeer::upgrade(const std::string& origin, const std::string& host) {
  send("GET /live HTTP/1.1\r\nHost: " + host + "\r\n" +
       (origin.empty() ? "" : "Origin: " + origin + "\r\n") +
       "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
       "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n");
  return header();
}

void WebPeer::open() {
  const std::string host = "127.0.0.1:" + std::to_string(port_);
  const std::string answer = upgrade("http://" + host, host);
  if (!answer.starts_with("HTTP/1.1 101")) throw std::runtime_error("refused: " + answer);
}

void WebPeer::send_message(std::span<const std::uint8_t> payload, int opcode) {
  std::string bytes(1, static_cast<char>(0x80 | opcode));
  if (payload.size() < 126) {
    bytes += static_cast<char>(0x80 | payload.size());
  } else {
    bytes += static_cast<char>(0x80 | 126);
    bytes += static_cast<char>(payload.size() >> 8);
    bytes += static_cast<char>(payload.size() & 0xFF);
  }
  bytes.append(4, '\0');  // a mask that changes nothing
  bytes.append(payload.begin(), payload.end());
  send(bytes);
}

std::optional<WebPeer::Message> WebPeer::receive() {
  for (;;) {
    if (!have(2)) return std::nullopt;
    const auto byte = [this](std::size_t i) { return static_cast<unsigned char>(buffer_[i]); };
    std::size_t length = byte(1) & 0x7F;
    const std::size_t extra = length == 126 ? 2 : length == 127 ? 8 : 0;
    if (!have(2 + extra)) return std::nullopt;
    if (extra > 0) length = 0;
    for (std::size_t i = 0; i < extra; ++i) length = length * 256 + byte(2 + i);
    if (!have(2 + extra + length)) return std::nullopt;
    Message message{byte(0) & 0x0F, {}};
    const std::string payload = buffer_.substr(2 + extra, length);
    message.payload.assign(payload.begin(), payload.end());
    buffer_.erase(0, 2 + extra + length);
    if (message.opcode != 9) return message;
  }
}

}  // namespace irdm::test
