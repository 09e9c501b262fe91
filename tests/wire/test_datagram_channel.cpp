#include <algorithm>
#include <cstdint>
#include <vector>

#include "common/wire/datagram_channel.hpp"
#include "common/wire/frame.hpp"
#include "common/wire/secret_key.hpp"
#include "tests/support/allocation_guard.hpp"
#include "tests/support/catch.hpp"
#include "tests/wire/from_hex.hpp"

using namespace irdm::wire;
using irdm::test::AllocationGuard;
using irdm::test::from_hex;

namespace {

using Bytes = std::vector<std::uint8_t>;
constexpr std::uint32_t kSession = 0x01020304;

/// The key to the server is 00 01 .. 0f, that to the bridge 10 11 .. 1f.
DatagramKeys keys() {
  KeyMaterial material{};
  for (std::size_t i = 0; i < material.size(); ++i) material[i] = static_cast<std::uint8_t>(i);
  return keys_of(material);
}

Bytes copy(std::span<const std::uint8_t> bytes) {
  return {bytes.begin(), bytes.end()};
}

struct BothEnds {
  DatagramChannel bridge{keys(), DatagramEnd::kBridge, kSession};
  DatagramChannel server{keys(), DatagramEnd::kServer, kSession};
};

}  // namespace

TEST_CASE("a datagram has its documented bytes") {
  BothEnds ends;
  const Bytes text = from_hex("00 01 00 00 49 52 44 4d");
  for (int i = 0; i < 5; ++i) ends.bridge.seal(text);
  // Sealed by another program (Python's cryptography, AESGCM).
  CHECK(copy(ends.bridge.seal(text)) ==
        from_hex("04 03 02 01 05 00 00 00 00 00 00 00 bd 73 b1 e7 c7 cb 7e 08 8f d4 78 ff "
                 "8d 13 9c 75 db 34 24 e4 33 ba 90 1c"));
}

TEST_CASE("what one end seals the other opens, either way, in any order") {
  BothEnds ends;
  for (DatagramChannel* from : {&ends.bridge, &ends.server}) {
    DatagramChannel& to = from == &ends.bridge ? ends.server : ends.bridge;
    const Bytes first = copy(from->seal(Bytes{1}));
    const Bytes second = copy(from->seal(Bytes(kLargestText, 2)));
    const Bytes third = copy(from->seal({}));
    CHECK(second.size() == kLargestDatagram);
    const DatagramChannel::Opened newest = to.open(second);
    REQUIRE(newest.verdict == DatagramVerdict::kOpened);
    CHECK(newest.number == 1);
    CHECK(newest.newest);
    CHECK(copy(newest.text) == Bytes(kLargestText, 2));
    const DatagramChannel::Opened late = to.open(first);
    REQUIRE(late.verdict == DatagramVerdict::kOpened);
    CHECK(late.number == 0);
    CHECK_FALSE(late.newest);
    CHECK(copy(late.text) == Bytes{1});
    CHECK(to.open(third).text.empty());
  }
  CHECK(ends.bridge.seal(Bytes(kLargestText + 1)).empty());
}

TEST_CASE("a datagram that came before is not opened again") {
  BothEnds ends;
  const Bytes datagram = copy(ends.bridge.seal(Bytes{1}));
  CHECK(ends.server.open(datagram).verdict == DatagramVerdict::kOpened);
  CHECK(ends.server.open(datagram).verdict == DatagramVerdict::kReplayed);
  // Nor one that is sent back to where it came from.
  CHECK(ends.bridge.open(datagram).verdict == DatagramVerdict::kForged);
}

TEST_CASE("a datagram of which one bit is another is not opened, and leaves no trace") {
  BothEnds ends;
  const Bytes datagram = copy(ends.bridge.seal(from_hex("00 01 00 00 49 52 44 4d")));
  for (std::size_t bit = 0; bit < 8 * datagram.size(); ++bit) {
    CAPTURE(bit);
    Bytes spoilt = datagram;
    spoilt[bit / 8] ^= static_cast<std::uint8_t>(1u << (bit % 8));
    CHECK(ends.server.open(spoilt).verdict ==
          (bit < 32 ? DatagramVerdict::kForeign : DatagramVerdict::kForged));
  }
  CHECK(ends.server.open(datagram).verdict == DatagramVerdict::kOpened);
}

TEST_CASE("a datagram that is cut, longer or of another session or key is not opened") {
  BothEnds ends;
  const Bytes datagram = copy(ends.bridge.seal(Bytes(kLargestText)));
  for (std::size_t size = 0; size < datagram.size(); ++size) {
    const DatagramVerdict verdict = ends.server.open(std::span(datagram).first(size)).verdict;
    REQUIRE((verdict == DatagramVerdict::kForeign || verdict == DatagramVerdict::kForged));
  }
  Bytes longer = datagram;
  longer.push_back(0);
  CHECK(ends.server.open(longer).verdict == DatagramVerdict::kForeign);
  CHECK(session_of(longer) == 0);
  CHECK(session_of(datagram) == kSession);
  DatagramChannel other_session(keys(), DatagramEnd::kServer, kSession + 1);
  CHECK(other_session.open(datagram).verdict == DatagramVerdict::kForeign);
  DatagramChannel other_key(keys_of(random_material()), DatagramEnd::kServer, kSession);
  CHECK(other_key.open(datagram).verdict == DatagramVerdict::kForged);
}

TEST_CASE("messages are sealed, opened and put together without an allocation") {
  BothEnds ends;
  FrameAssembly assembly;
  ContactModelMessage model{.stylus = 0};
  model.model.valid = true;
  model.model.horizon = irdm::kMaxHorizon;
  model.model.dt = 0.002;
  for (auto& response : model.model.response) response.setIdentity();
  const Message sent = model;
  int whole = 0;
  const AllocationGuard guard;
  for (std::uint64_t i = 0; i < 100; ++i) {
    const FrameBytes frame = encode_frame(sent, kSession, i, 1);
    for (std::size_t part = 0; part < part_count(frame.view()); ++part) {
      const auto datagram = ends.server.seal(part_text(frame.view(), part).view());
      const DatagramChannel::Opened opened = ends.bridge.open(datagram);
      whole += assembly.take(opened.number, opened.text) ? 1 : 0;
    }
  }
  const std::uint64_t allocations = guard.count();
  CHECK(whole == 100);
  CHECK(allocations == 0);
}
