#include <cstdint>
#include <string_view>
#include <vector>

#include "common/wire/frame.hpp"
#include "tests/support/catch.hpp"

using irdm::wire::crc32c;

TEST_CASE("crc32c gives the published check value, whole or in two parts") {
  const std::string_view text = "123456789";
  const std::vector<std::uint8_t> bytes(text.begin(), text.end());
  const std::span<const std::uint8_t> all(bytes);
  CHECK(crc32c(all) == 0xE3069283u);
  CHECK(crc32c(all.first(4), all.subspan(4)) == 0xE3069283u);
}

TEST_CASE("crc32c of 32 zero bytes is the value of RFC 3720") {
  CHECK(crc32c(std::vector<std::uint8_t>(32, 0)) == 0x8A9136AAu);
}
