#include "tests/support/raw_datagrams.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <stdexcept>

#include "tests/support/eventually.hpp"

namespace irdm::test {
namespace {

sockaddr_in address_of(const std::string& address, std::uint16_t port) {
  sockaddr_in found{};
  found.sin_family = AF_INET;
  found.sin_port = htons(port);
  ::inet_pton(AF_INET, address.c_str(), &found.sin_addr);
  return found;
}

bool readable(int descriptor, int milliseconds) {
  pollfd entry{descriptor, POLLIN, 0};
  return ::poll(&entry, 1, milliseconds) > 0;
}

}  // namespace

RawDatagrams::RawDatagrams(const std::string& address)
    : descriptor_(::socket(AF_INET, SOCK_DGRAM, 0)) {
  sockaddr_in own = address_of(address, 0);
  socklen_t size = sizeof own;
  if (::bind(descriptor_, reinterpret_cast<const sockaddr*>(&own), size) != 0 ||
      ::getsockname(descriptor_, reinterpret_cast<sockaddr*>(&own), &size) != 0) {
    throw std::runtime_error("cannot bind");
  }
  port_ = ntohs(own.sin_port);
}

RawDatagrams::~RawDatagrams() {
  ::close(descriptor_);
}

void RawDatagrams::send(std::span<const std::uint8_t> datagram, std::uint16_t port) {
  const sockaddr_in to = address_of("127.0.0.1", port);
  ::sendto(descriptor_, datagram.data(), datagram.size(), 0, reinterpret_cast<const sockaddr*>(&to),
           sizeof to);
}

std::optional<std::vector<std::uint8_t>> RawDatagrams::receive() {
  if (!readable(descriptor_, kDeadlineMs)) return std::nullopt;
  std::vector<std::uint8_t> datagram(65536);
  sockaddr_in from{};
  socklen_t size = sizeof from;
  const ssize_t count = ::recvfrom(descriptor_, datagram.data(), datagram.size(), 0,
                                   reinterpret_cast<sockaddr*>(&from), &size);
  if (count < 0) return std::nullopt;
  sender_ = ntohs(from.sin_port);
  datagram.resize(static_cast<std::size_t>(count));
  return datagram;
}

bool RawDatagrams::is_free(std::uint16_t port) {
  const int descriptor = ::socket(AF_INET, SOCK_DGRAM, 0);
  const sockaddr_in there = address_of("127.0.0.1", port);
  const bool bound =
      ::bind(descriptor, reinterpret_cast<const sockaddr*>(&there), sizeof there) == 0;
  ::close(descriptor);
  return bound;
}

bool RawDatagrams::any() const {
  return readable(descriptor_, 0);
}

std::vector<std::uint8_t> RawChannel::seal(std::span<const std::uint8_t> text) {
  const std::span<const std::uint8_t> datagram = channel.seal(text);
  return {datagram.begin(), datagram.end()};
}

std::vector<std::uint8_t> RawChannel::seal(const wire::Message& message, std::uint64_t sequence) {
  const wire::FrameBytes frame = wire::encode_frame(message, session, sequence, 0);
  return seal(wire::part_text(frame.view(), 0).view());
}

std::optional<wire::Frame> RawChannel::receive(RawDatagrams& socket) {
  while (const std::optional<std::vector<std::uint8_t>> datagram = socket.receive()) {
    const wire::DatagramChannel::Opened opened = channel.open(*datagram);
    if (opened.verdict != wire::DatagramVerdict::kOpened) return std::nullopt;
    if (wire::is_probe(opened.text)) continue;
    const std::optional<wire::Frame> frame = assembly.take(opened.number, opened.text);
    if (frame) return frame;
  }
  return std::nullopt;
}

}  // namespace irdm::test
