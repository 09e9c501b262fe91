#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/wire/datagram_channel.hpp"
#include "common/wire/message.hpp"
#include "tests/fuzz/harness.hpp"

namespace irdm::fuzz {

/// The datagrams of an end that knows the keys and says what the fuzzer likes. What it makes is
/// valid until the next call.
class FarEnd {
 public:
  FarEnd(const wire::DatagramKeys& keys, wire::DatagramEnd end, std::uint32_t session)
      : channel_(keys, end, session) {}

  /// @param text as much of it as fits
  Input sealed(Input text);
  /// All parts of a frame with the right checksum.
  std::vector<std::vector<std::uint8_t>> frame(Input bytes);
  /// So many get lost.
  void lose(std::size_t count);
  /// The last one; empty where there is none.
  Input last() const { return last_; }
  /// The last one, but for a bit.
  Input spoilt(std::size_t bit);

 private:
  wire::DatagramChannel channel_;
  std::vector<std::uint8_t> last_;
  std::vector<std::uint8_t> spoilt_;
};

/// One after the other: a byte for what it is, a u16, and the bytes of those kinds that have some,
/// so many.
class Records {
 public:
  struct Record {
    std::uint8_t kind = 0;
    std::size_t number = 0;
    Input bytes;  ///< of the kinds below `with_bytes`; else empty
  };
  /// @param kinds so many there are; a byte beyond counts from 0 again
  Records(Input input, std::uint8_t kinds, std::uint8_t with_bytes)
      : rest_(input), kinds_(kinds), with_bytes_(with_bytes) {}
  /// Nothing at the end.
  std::optional<Record> next();

 private:
  Input rest_;
  std::uint8_t kinds_;
  std::uint8_t with_bytes_;
};

/// Of the messages of a stream, as far as it is one. Ends the process where it breaks the protocol.
std::vector<wire::Message> messages_of(Input stream);

}  // namespace irdm::fuzz
