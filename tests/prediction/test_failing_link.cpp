#include <algorithm>

#include "tests/prediction/failing_link.hpp"
#include "tests/support/catch.hpp"

// Whatever goes wrong, the hand feels nothing soon, and nothing jumps.

using namespace irdm;
using namespace irdm::test;

namespace {

constexpr std::int64_t kMillisecond = 1'000'000;
constexpr std::int64_t kFade = 30 * kMillisecond;
constexpr std::int64_t kTick = kMillisecond;  // the first one of a bridge that goes on

void check(Cause cause, bool predict, int phase) {
  CAPTURE(word(cause), predict, phase);
  const FailingLink::Outcome outcome =
      FailingLink(cause, predict, static_cast<std::uint64_t>(phase)).run();
  REQUIRE(outcome.force_before > 0.2);
  REQUIRE(outcome.zero_ns >= 0);
  CHECK(outcome.horizon_ns <= (predict ? 50 : 20) * kMillisecond);
  const std::int64_t valid_ns = std::max<std::int64_t>(outcome.valid_ns, 0);
  const std::int64_t bound_ns = valid_ns + outcome.horizon_ns + kFade;
  CHECK(outcome.zero_ns <= std::max(bound_ns, outcome.absent_ns + kTick));
  // It comes back slowly: nothing for a while, or the ramp's share.
  CHECK(outcome.force_after < 0.7);
  CHECK(outcome.largest_rise <= 0.3 * (1 + 1e-9));
}

void check_all(int phases) {
  for (const bool predict : {false, true}) {
    for (int c = 0; c < kCauses; ++c) {
      for (int phase = 0; phase < phases; ++phase) check(static_cast<Cause>(c), predict, phase);
    }
  }
}

}  // namespace

TEST_CASE("failing link: no force soon after the last good frame, for every cause") {
  check_all(3);
}

TEST_CASE("failing link: the same at two hundred moments each", "[exhaustive]") {
  check_all(200);
}
