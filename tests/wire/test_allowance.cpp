#include "common/wire/token_bucket.hpp"
#include "tests/support/catch.hpp"

using irdm::TokenBucket;

namespace {

int takes(TokenBucket& allowance, std::int64_t now_ns, int tries) {
  int taken = 0;
  for (int i = 0; i < tries; ++i) taken += allowance.take(now_ns) ? 1 : 0;
  return taken;
}

constexpr std::int64_t kSecond = 1'000'000'000;

}  // namespace

TEST_CASE("an allowance gives its burst, then its rate, and saves up no more than the burst") {
  TokenBucket allowance(10.0, 5.0);
  CHECK(takes(allowance, kSecond, 100) == 5);
  CHECK(takes(allowance, kSecond + kSecond / 2, 100) == 5);
  CHECK(takes(allowance, kSecond + kSecond * 7 / 10, 100) == 2);
  CHECK(takes(allowance, 100 * kSecond, 100) == 5);
}

TEST_CASE("an allowance gives nothing for time that goes back") {
  TokenBucket allowance(10.0, 1.0);
  CHECK(takes(allowance, 5 * kSecond, 2) == 1);
  CHECK(takes(allowance, 4 * kSecond, 2) == 0);
  CHECK(takes(allowance, 5 * kSecond, 2) == 0);
}
