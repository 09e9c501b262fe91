#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "common/wire/datagram_channel.hpp"
#include "tests/support/allocation_guard.hpp"
#include "tests/support/catch.hpp"
#include "tests/wire/from_hex.hpp"

using irdm::test::AllocationGuard;
using irdm::test::from_hex;
using irdm::wire::AesGcm;

namespace {

template <std::size_t N>
std::array<std::uint8_t, N> array_of(const std::string& hex) {
  std::array<std::uint8_t, N> bytes{};
  const std::vector<std::uint8_t> found = from_hex(hex);
  REQUIRE(found.size() == N);
  std::copy(found.begin(), found.end(), bytes.begin());
  return bytes;
}

// McGrew and Viega, The Galois/Counter Mode of Operation, test case 4.
const std::string kText =
    "d9313225f88406e5a55909c5aff5269a86a7a9531534f7da2e4c303d8a318a72"
    "1c3c0c95956809532fcf0e2449a6b525b16aedf5aa0de657ba637b39";
const std::string kSealed =
    "42831ec2217774244b7221b784d0d49ce3aa212f2c02a4e035c17e2329aca12e"
    "21d514b25466931c7d8f6a5aac84aa051ba30b396a0aac973d58e091";

struct Case {
  AesGcm::Key key = array_of<16>("feffe9928665731c6d6a8f9467308308");
  std::array<std::uint8_t, 12> nonce = array_of<12>("cafebabefacedbaddecaf888");
  std::vector<std::uint8_t> clear = from_hex("feedfacedeadbeeffeedfacedeadbeefabaddad2");
  std::array<std::uint8_t, 16> tag = array_of<16>("5bc94fbc3221a5db94fae95ae7121a47");
};

}  // namespace

TEST_CASE("AES-128-GCM seals and opens its published test case") {
  const Case known;
  std::vector<std::uint8_t> text = from_hex(kText);
  std::array<std::uint8_t, 16> tag{};
  AesGcm sealer(AesGcm::Use::kSeal, known.key);
  REQUIRE(sealer.seal(known.nonce, known.clear, text, tag));
  CHECK(text == from_hex(kSealed));
  CHECK(tag == known.tag);
  AesGcm opener(AesGcm::Use::kOpen, known.key);
  REQUIRE(opener.open(known.nonce, known.clear, text, tag));
  CHECK(text == from_hex(kText));
}

TEST_CASE("AES-128-GCM opens nothing of which a bit is another, and then the right one again") {
  const Case known;
  AesGcm opener(AesGcm::Use::kOpen, known.key);
  for (std::size_t bit = 0; bit < 8 * 16; ++bit) {
    CAPTURE(bit);
    const auto flip = [bit](auto bytes) {
      bytes[(bit / 8) % bytes.size()] ^= static_cast<std::uint8_t>(1u << (bit % 8));
      return bytes;
    };
    std::vector<std::uint8_t> text = from_hex(kSealed);
    CHECK_FALSE(opener.open(known.nonce, known.clear, text, flip(known.tag)));
    text = from_hex(kSealed);
    CHECK_FALSE(opener.open(flip(known.nonce), known.clear, text, known.tag));
    text = from_hex(kSealed);
    CHECK_FALSE(opener.open(known.nonce, flip(known.clear), text, known.tag));
    text = flip(from_hex(kSealed));
    CHECK_FALSE(opener.open(known.nonce, known.clear, text, known.tag));
    text = from_hex(kSealed);
    CHECK(opener.open(known.nonce, known.clear, text, known.tag));
  }
}

TEST_CASE("AES-128-GCM allocates nothing after it was made") {
  const Case known;
  AesGcm sealer(AesGcm::Use::kSeal, known.key);
  AesGcm opener(AesGcm::Use::kOpen, known.key);
  std::vector<std::uint8_t> text = from_hex(kText);
  std::array<std::uint8_t, 16> tag{};
  int good = 0;
  const AllocationGuard guard;
  for (int i = 0; i < 1000; ++i) {
    good += sealer.seal(known.nonce, known.clear, text, tag) ? 1 : 0;
    good += opener.open(known.nonce, known.clear, text, tag) ? 1 : 0;
    tag[0] ^= 1;
    good += opener.open(known.nonce, known.clear, text, tag) ? 100 : 0;
  }
  const std::uint64_t allocations = guard.count();
  CHECK(good == 2000);
  CHECK(allocations == 0);
}
