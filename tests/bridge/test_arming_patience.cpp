#include "device_bridge/safety/arming.hpp"
#include "tests/bridge/milliseconds.hpp"
#include "tests/support/catch.hpp"

using irdm::ArmingPatience;
using irdm::test::kMs;

namespace {

/// How often it is lost in a session of this length that is looked at every 5 ms.
int losses(ArmingPatience& patience, std::int64_t& now_ns, std::int64_t length_ns, bool good) {
  int count = 0;
  for (const std::int64_t end_ns = now_ns + length_ns; now_ns <= end_ns; now_ns += 5 * kMs) {
    count += patience.lost(now_ns, good) ? 1 : 0;
  }
  patience.pause();
  return count;
}

}  // namespace

TEST_CASE("patience ends every five seconds of a bad link") {
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

TEST_CASE("patience comes back as slowly as it went") {
  ArmingPatience patience;
  std::int64_t now_ns = 0;
  for (int i = 0; i < 5; ++i) {
    CHECK(losses(patience, now_ns, 4000 * kMs, false) == 0);
    CHECK(losses(patience, now_ns, 4000 * kMs, true) == 0);
  }
}

TEST_CASE("a link that is good for moments only wears patience out") {
  ArmingPatience patience;
  std::int64_t now_ns = 0;
  int count = 0;
  for (int i = 0; i < 5; ++i) {
    count += losses(patience, now_ns, 2000 * kMs, false);
    count += losses(patience, now_ns, 500 * kMs, true);
  }
  CHECK(count == 1);
}
