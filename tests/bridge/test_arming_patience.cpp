#include <catch2/catch.hpp>

#include "device_bridge/link/arming_patience.hpp"
#include "tests/bridge/milliseconds.hpp"

using irdm::ArmingPatience;
using irdm::test::kMs;

namespace {

/// How often it is lost in a session of this length that is looked at every 5 ms.
int losses(ArmingPatience& patience, std::int64_t& now_ns, std::int64_t length_ns, bool armed) {
  int count = 0;
  for (const std::int64_t end_ns = now_ns + length_ns; now_ns <= end_ns; now_ns += 5 * kMs) {
    count += patience.lost(now_ns, armed) ? 1 : 0;
  }
  patience.pause();
  return count;
}

}  // namespace

TEST_CASE("patience ends every five seconds without a stylus that is armed") {
  ArmingPatience patience;
  std::int64_t now_ns = 1'000'000 * kMs;
  CHECK(losses(patience, now_ns, 4990 * kMs, false) == 0);
  CHECK(losses(patience, now_ns, 10'100 * kMs, false) == 3);
}

TEST_CASE("patience ends with a link that is made anew every second, and not while there is none") {
  ArmingPatience patience;
  std::int64_t now_ns = 0;
  int count = 0;
  for (int session = 0; session < 11; ++session, now_ns += 60'000 * kMs) {
    count += losses(patience, now_ns, 1000 * kMs, false);
  }
  CHECK(count == 2);
}

TEST_CASE("patience is whole again once a stylus was armed") {
  ArmingPatience patience;
  std::int64_t now_ns = 0;
  for (int i = 0; i < 5; ++i) {
    CHECK(losses(patience, now_ns, 4000 * kMs, false) == 0);
    CHECK(losses(patience, now_ns, 100 * kMs, true) == 0);
  }
}
