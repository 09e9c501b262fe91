#include "tests/fuzz/far_end.hpp"

#include <algorithm>

#include "common/wire/frame.hpp"
#include "common/wire/protocol_error.hpp"
#include "tests/fuzz/line.hpp"

namespace irdm::fuzz {

Input FarEnd::sealed(Input text) {
  const Input datagram = channel_.seal(text.first(std::min(text.size(), wire::kLargestText)));
  last_.assign(datagram.begin(), datagram.end());
  return last_;
}

std::vector<std::vector<std::uint8_t>> FarEnd::frame(Input bytes) {
  const auto whole =
      mended(bytes.first(std::min(bytes.size(), wire::kHeaderSize + wire::kLargestPayload)));
  std::vector<std::vector<std::uint8_t>> datagrams;
  for (std::size_t part = 0; part < wire::part_count(whole); ++part) {
    sealed(wire::part_text(whole, part).view());
    datagrams.push_back(last_);
  }
  return datagrams;
}

void FarEnd::lose(std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) channel_.seal({});
}

Input FarEnd::spoilt(std::size_t bit) {
  spoilt_ = last_;
  if (!spoilt_.empty()) {
    spoilt_[bit / 8 % spoilt_.size()] ^= static_cast<std::uint8_t>(1u << (bit % 8));
  }
  return spoilt_;
}

std::optional<Records::Record> Records::next() {
  constexpr std::size_t kHead = 3;
  if (rest_.size() < kHead) return std::nullopt;
  Record record{static_cast<std::uint8_t>(rest_[0] % kinds_), rest_[1] + 256u * rest_[2], {}};
  rest_ = rest_.subspan(kHead);
  if (record.kind < with_bytes_) {
    record.bytes = rest_.first(std::min(record.number, rest_.size()));
    rest_ = rest_.subspan(record.bytes.size());
  }
  return record;
}

std::vector<wire::Message> messages_of(Input stream) {
  wire::FrameReader reader;
  std::vector<wire::Message> messages;
  try {
    while (const auto frame = reader.read(stream)) messages.push_back(frame->message);
  } catch (const wire::ProtocolError&) {
    expect(false, "what is said keeps to the protocol");
  }
  return messages;
}

}  // namespace irdm::fuzz
