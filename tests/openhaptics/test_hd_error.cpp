#include <string>

#include "device_bridge/openhaptics/hd_error.hpp"
#include "tests/support/catch.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm::hd;

TEST_CASE("every error of the driver has the meaning that is safe") {
  CHECK(describe(0x0000).meaning == Meaning::kNothing);
  CHECK(describe(0x0200).meaning == Meaning::kWarm);
  for (const Code code : {0x0201u, 0x0202u, 0x0203u}) {
    CHECK(describe(code).meaning == Meaning::kWarning);
  }
  for (const Code code : {0x0204u, 0x0304u, 0x0501u, 0x0600u}) {
    CHECK(describe(code).meaning == Meaning::kUnsafe);
  }
  for (const Code code : {0x0104u, 0x0300u, 0x0302u, 0x0303u}) {
    CHECK(describe(code).meaning == Meaning::kLost);
  }
  for (const Code code : {0x0100u, 0x0101u, 0x0102u, 0x0103u, 0x0400u, 0x0401u, 0x0402u}) {
    CHECK(describe(code).meaning == Meaning::kBadFrame);
  }
  CHECK(describe(0x0777).meaning == Meaning::kUnsafe);
}

TEST_CASE("an error of the driver is told by name, number and words") {
  CHECK_THAT(to_text({.code = 0x0302, .internal = 5}),
             ContainsSubstring("HD_COMM_ERROR 0x0302, internal 5: communication"));
  CHECK_THAT(to_text({.code = 0x0203}), ContainsSubstring("HD_EXCEEDED_MAX_VELOCITY 0x0203: "));
  CHECK_THAT(to_text({.code = 0xABCD}), ContainsSubstring("unknown error 0xABCD"));
}

TEST_CASE("what only a fault of ours can cause is told as such") {
  for (const Code code : {0x0204u, 0x0402u}) {
    CHECK_THAT(describe(code).remedy, ContainsSubstring("fault of irdm-bridge"));
  }
}
