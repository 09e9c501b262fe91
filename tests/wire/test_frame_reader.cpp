#include <bit>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "common/wire/frame.hpp"
#include "common/wire/protocol_error.hpp"
#include "tests/support/catch.hpp"

using namespace irdm::wire;
using irdm::Quaternion;
using irdm::Vector3;

namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t kVersionAt = 4;
constexpr std::size_t kTypeAt = 6;
constexpr std::size_t kSizeAt = 8;
constexpr std::size_t kCrcAt = 32;

Bytes encoded_bytes(const Message& message, std::uint64_t sequence = 0) {
  const FrameBytes frame = encode_frame(message, 1, sequence, 2);
  return {frame.view().begin(), frame.view().end()};
}

/// `bytes` with a little-endian number of `size` bytes put in at `at`.
Bytes with(Bytes bytes, std::size_t at, std::uint64_t value, std::size_t size) {
  for (std::size_t i = 0; i < size; ++i)
    bytes.at(at + i) = static_cast<std::uint8_t>(value >> (8 * i));
  return bytes;
}

/// The same with a checksum that is right again: what is refused is the value itself.
Bytes with_value(Bytes bytes, std::size_t at, std::uint64_t value, std::size_t size) {
  bytes = with(std::move(bytes), kHeaderSize + at, value, size);
  const std::span<const std::uint8_t> all(bytes);
  return with(bytes, kCrcAt, crc32c(all.first(kCrcAt), all.subspan(kHeaderSize)), 4);
}

/// The fault that reading these bytes is refused for.
ProtocolFault fault_of(const Bytes& bytes) {
  FrameReader reader;
  std::span<const std::uint8_t> rest(bytes);
  try {
    while (reader.read(rest)) {
    }
  } catch (const ProtocolError& error) {
    CHECK(std::string(error.what()) != "");
    return error.fault();
  }
  FAIL("nothing was refused");
  return {};
}

std::uint64_t bits(double value) {
  return std::bit_cast<std::uint64_t>(value);
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

TEST_CASE("reader refuses a wrong magic") {
  CHECK(fault_of(with(encoded_bytes(Goodbye{}), 0, 'X', 1)) == ProtocolFault::kWrongMagic);
}

TEST_CASE("reader refuses another version and names both") {
  const Bytes bytes = with(encoded_bytes(Hello{}), kVersionAt, 99, 2);
  CHECK(fault_of(bytes) == ProtocolFault::kWrongVersion);
  CHECK(fault_of(with(bytes, kVersionAt, 0, 2)) == ProtocolFault::kWrongVersion);
  FrameReader reader;
  std::span<const std::uint8_t> rest(bytes);
  try {
    reader.read(rest);
    FAIL("not refused");
  } catch (const VersionMismatch& error) {
    CHECK(error.theirs_min() == 99);
    CHECK(error.theirs_max() == 99);
    CHECK(std::string(error.what()) == "peer speaks protocol version 99, this program 1");
  }
}

TEST_CASE("reader refuses types that are not defined, reserved ones included") {
  for (const std::uint64_t type : {0, 8, 15, 19, 65535}) {
    CHECK(fault_of(with(encoded_bytes(Goodbye{}), kTypeAt, type, 2)) ==
          ProtocolFault::kUnknownType);
  }
}

TEST_CASE("reader refuses a length beyond the bound from the header alone") {
  for (const std::uint64_t size : {kMaxPayload + 1, std::size_t{0xFFFFFFFF}}) {
    Bytes bytes = with(encoded_bytes(Goodbye{}), kSizeAt, size, 4);
    bytes.resize(kHeaderSize);  // no payload follows: it is not waited for
    CHECK(fault_of(bytes) == ProtocolFault::kTooLong);
  }
}

TEST_CASE(
    "reader refuses a length that is not the type's, below and above, from the header alone") {
  for (const std::uint64_t size : {std::size_t{0}, std::size_t{79}, std::size_t{81}, kMaxPayload}) {
    Bytes bytes = with(encoded_bytes(SampleMessage{}), kSizeAt, size, 4);
    bytes.resize(kHeaderSize);
    CHECK(fault_of(bytes) == ProtocolFault::kWrongLength);
  }
}

TEST_CASE("reader refuses every single flipped bit of a frame") {
  const Bytes good = encoded_bytes(SampleMessage{});
  for (std::size_t bit = 0; bit < 8 * good.size(); ++bit) {
    Bytes bad = good;
    bad[bit / 8] = static_cast<std::uint8_t>(bad[bit / 8] ^ (1u << (bit % 8)));
    const ProtocolFault fault = fault_of(bad);
    if (bit / 8 >= kSizeAt + 4) CHECK(fault == ProtocolFault::kChecksum);
  }
}

TEST_CASE("reader refuses values outside their range") {
  const Bytes hello = encoded_bytes(Hello{});
  CHECK(fault_of(with_value(hello, 0, 2, 2)) == ProtocolFault::kBadValue);   // empty version range
  CHECK(fault_of(with_value(hello, 8, 0, 2)) == ProtocolFault::kBadValue);   // no stylus
  CHECK(fault_of(with_value(hello, 10, 2, 1)) == ProtocolFault::kBadValue);  // flag
  for (const std::uint64_t letter : {0x01, 0x1B, 0x7F, 0x80, 0xFF}) {
    CHECK(fault_of(with_value(hello, 12, letter, 1)) == ProtocolFault::kBadValue);  // name
    CHECK(fault_of(with_value(encoded_bytes(Refuse{}), 8, letter, 1)) == ProtocolFault::kBadValue);
  }
  const Bytes welcome = encoded_bytes(Welcome{.session = 1, .dt = 0.002});
  CHECK(fault_of(with_value(welcome, 8, 0, 4)) == ProtocolFault::kBadValue);   // session
  CHECK(fault_of(with_value(welcome, 12, 2, 1)) == ProtocolFault::kBadValue);  // flag
  CHECK(fault_of(with_value(welcome, 16, bits(0.0), 8)) == ProtocolFault::kBadValue);
  CHECK(fault_of(with_value(welcome, 16, bits(-0.002), 8)) == ProtocolFault::kBadValue);
  CHECK(fault_of(with_value(welcome, 16, bits(1.001), 8)) == ProtocolFault::kBadValue);
  CHECK(fault_of(with_value(welcome, 16, bits(kNan), 8)) == ProtocolFault::kNotFinite);
  const Bytes report = encoded_bytes(Report{});
  for (const std::size_t at : {8, 12, 16, 20, 24, 28}) {  // singles: -1, NaN
    CHECK(fault_of(with_value(report, at, 0xBF800000, 4)) == ProtocolFault::kBadValue);
    CHECK(fault_of(with_value(report, at, 0x7FC00000, 4)) == ProtocolFault::kNotFinite);
  }
  const Bytes status = encoded_bytes(Status{});
  for (const std::size_t at : {32, 36, 40, 44, 48, 52, 56}) {
    CHECK(fault_of(with_value(status, at, 0xBF800000, 4)) == ProtocolFault::kBadValue);
    CHECK(fault_of(with_value(status, at, 0x7FC00000, 4)) == ProtocolFault::kNotFinite);
  }
  CHECK(fault_of(with_value(encoded_bytes(Refuse{}), 0, 0, 2)) == ProtocolFault::kBadValue);
  CHECK(fault_of(with_value(encoded_bytes(Refuse{}), 0, 7, 2)) == ProtocolFault::kBadValue);
  CHECK(fault_of(with_value(encoded_bytes(Goodbye{}), 0, 4, 2)) == ProtocolFault::kBadValue);
}

TEST_CASE("reader refuses each number of a sample that is not finite or too large") {
  const Bytes sample = encoded_bytes(SampleMessage{});
  for (const std::size_t at : {24, 32, 40}) {
    CHECK(fault_of(with_value(sample, at, bits(kNan), 8)) == ProtocolFault::kNotFinite);
    CHECK(fault_of(with_value(sample, at, bits(-kInfinity), 8)) == ProtocolFault::kNotFinite);
    CHECK(fault_of(with_value(sample, at, bits(-1000.1), 8)) == ProtocolFault::kBadValue);
  }
  for (const std::size_t at : {48, 56, 64, 72}) {
    CHECK(fault_of(with_value(sample, at, bits(kNan), 8)) == ProtocolFault::kNotFinite);
    CHECK(fault_of(with_value(sample, at, bits(kInfinity), 8)) == ProtocolFault::kNotFinite);
    CHECK(fault_of(with_value(sample, at, bits(0.5), 8)) == ProtocolFault::kBadValue);
  }
}

TEST_CASE("reader refuses each number of a force that is not finite, and an unknown contact") {
  const Bytes force = encoded_bytes(ForceMessage{});
  for (std::size_t at = 32; at < 80; at += 8) {
    CHECK(fault_of(with_value(force, at, bits(kNan), 8)) == ProtocolFault::kNotFinite);
    CHECK(fault_of(with_value(force, at, bits(kInfinity), 8)) == ProtocolFault::kNotFinite);
  }
  CHECK(fault_of(with_value(force, 2, 3, 1)) == ProtocolFault::kBadValue);
  const Bytes with_torque = encoded_bytes(ForceMessage{.with_torque = true});
  for (std::size_t at = 32; at < 104; at += 8) {
    CHECK(fault_of(with_value(with_torque, at, bits(kNan), 8)) == ProtocolFault::kNotFinite);
    CHECK(fault_of(with_value(with_torque, at, bits(-kInfinity), 8)) == ProtocolFault::kNotFinite);
  }
}

TEST_CASE("reserved bytes are not looked at") {
  const Bytes bytes = with_value(encoded_bytes(Goodbye{}), 2, 0xFFFF, 2);
  FrameReader reader;
  std::span<const std::uint8_t> rest(bytes);
  CHECK(reader.read(rest));
}

TEST_CASE("reader puts frames together from any pieces") {
  Bytes stream;
  for (std::uint64_t i = 0; i < 50; ++i) {
    const Message message = i % 2 == 0 ? Message(SampleMessage{}) : Message(Goodbye{});
    const Bytes frame = encoded_bytes(message, i);
    stream.insert(stream.end(), frame.begin(), frame.end());
  }
  std::mt19937 random(1);
  for (const std::size_t largest : {std::size_t{1}, std::size_t{7}, std::size_t{500}}) {
    std::uniform_int_distribution<std::size_t> size(1, largest);
    FrameReader reader;
    std::uint64_t expected = 0;
    std::span<const std::uint8_t> rest(stream);
    while (!rest.empty()) {
      std::span<const std::uint8_t> piece = rest.first(std::min(size(random), rest.size()));
      rest = rest.subspan(piece.size());
      while (const std::optional<Frame> frame = reader.read(piece)) {
        CHECK(frame->header.sequence == expected++);
      }
      CHECK(piece.empty());
    }
    CHECK(expected == 50);
    CHECK_FALSE(reader.partial());
  }
}

TEST_CASE("reader tells a frame that is not complete") {
  const Bytes bytes = encoded_bytes(Goodbye{});
  std::span<const std::uint8_t> rest = std::span(bytes).first(bytes.size() - 1);
  FrameReader reader;
  CHECK_FALSE(reader.partial());
  CHECK_FALSE(reader.read(rest));
  CHECK(reader.partial());
}

TEST_CASE("reader refuses garbage, whatever it is") {
  std::mt19937 random(2);
  std::uniform_int_distribution<int> byte(0, 255);
  for (int run = 0; run < 200; ++run) {
    Bytes garbage(kHeaderSize + 100);
    for (std::uint8_t& each : garbage) each = static_cast<std::uint8_t>(byte(random));
    // From the start, and after a good frame.
    CHECK(fault_of(garbage) == ProtocolFault::kWrongMagic);
    Bytes after = encoded_bytes(SampleMessage{});
    after.insert(after.end(), garbage.begin(), garbage.end());
    CHECK(fault_of(after) == ProtocolFault::kWrongMagic);
  }
}
