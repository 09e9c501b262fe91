#include "common/wire/datagram_channel.hpp"

#include <algorithm>

#include "common/wire/bytes.hpp"

namespace irdm::wire {
namespace {

constexpr std::size_t kSmallestDatagram = kDatagramHeaderSize + AesGcm::kTagSize;

}  // namespace

std::uint32_t session_of(std::span<const std::uint8_t> datagram) noexcept {
  if (datagram.size() < kSmallestDatagram || datagram.size() > kLargestDatagram) return 0;
  return ByteReader(datagram).get<std::uint32_t>();
}

DatagramChannel::DatagramChannel(const DatagramKeys& keys, DatagramEnd end, std::uint32_t session)
    : session_(session),
      sealer_(AesGcm::Use::kSeal, end == DatagramEnd::kBridge ? keys.to_server : keys.to_bridge),
      opener_(AesGcm::Use::kOpen, end == DatagramEnd::kBridge ? keys.to_bridge : keys.to_server) {}

std::span<const std::uint8_t> DatagramChannel::seal(std::span<const std::uint8_t> text) noexcept {
  if (text.size() > kLargestText) return {};
  const std::span<std::uint8_t> datagram =
      std::span(sealed_).first(kSmallestDatagram + text.size());
  ByteWriter header(datagram.first<kDatagramHeaderSize>());
  header.put(session_);
  header.put(next_number_++);
  const std::span<std::uint8_t> body = datagram.subspan(kDatagramHeaderSize, text.size());
  std::copy(text.begin(), text.end(), body.begin());
  const std::span<const std::uint8_t, kDatagramHeaderSize> nonce =
      datagram.first<kDatagramHeaderSize>();
  if (!sealer_.seal(nonce, nonce, body, datagram.last<AesGcm::kTagSize>())) return {};
  return datagram;
}

// Nothing of it is believed before its tag was checked, not even its number.
DatagramChannel::Opened DatagramChannel::open(std::span<const std::uint8_t> datagram) noexcept {
  if (session_of(datagram) != session_) return {};
  const std::span<const std::uint8_t, kDatagramHeaderSize> nonce =
      datagram.first<kDatagramHeaderSize>();
  const std::span<const std::uint8_t> body =
      datagram.subspan(kDatagramHeaderSize, datagram.size() - kSmallestDatagram);
  const std::span<std::uint8_t> text = std::span(opened_).first(body.size());
  std::copy(body.begin(), body.end(), text.begin());
  if (!opener_.open(nonce, nonce, text, datagram.last<AesGcm::kTagSize>())) {
    return {.verdict = DatagramVerdict::kForged};
  }
  ByteReader header(nonce);
  header.skip(sizeof session_);
  const auto number = header.get<std::uint64_t>();
  if (!window_.fresh(number)) return {.verdict = DatagramVerdict::kReplayed};
  return {.verdict = DatagramVerdict::kOpened,
          .number = number,
          .newest = window_.take(number),
          .text = text};
}

}  // namespace irdm::wire
