#include "common/wire/datagram_link.hpp"

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

}  // namespace irdm::wire
