#include <algorithm>
#include <cstdint>
#include <limits>
#include <random>
#include <set>

#include "common/wire/datagram_channel.hpp"
#include "tests/support/catch.hpp"

using irdm::wire::ReplayWindow;

TEST_CASE("a number counts once, and not when it is older than the window") {
  ReplayWindow window;
  CHECK(window.fresh(0));
  CHECK(window.take(5000));
  CHECK_FALSE(window.fresh(5000));
  CHECK(window.fresh(4999));
  CHECK(window.fresh(5001));
  CHECK(window.fresh(5000 - ReplayWindow::kWidth + 1));
  CHECK_FALSE(window.fresh(5000 - ReplayWindow::kWidth));
  CHECK_FALSE(window.fresh(0));
  CHECK_FALSE(window.take(4999));
  CHECK_FALSE(window.fresh(4999));
}

TEST_CASE("numbers at the ends of their range") {
  ReplayWindow window;
  constexpr std::uint64_t kLast = std::numeric_limits<std::uint64_t>::max();
  CHECK(window.take(0));
  CHECK_FALSE(window.fresh(0));
  CHECK(window.take(kLast));
  CHECK_FALSE(window.fresh(kLast));
  CHECK(window.fresh(kLast - 1));
  CHECK_FALSE(window.fresh(0));
}

TEST_CASE("the window agrees with a memory of all numbers") {
  std::mt19937 random(1);
  for (int run = 0; run < 20; ++run) {
    ReplayWindow window;
    std::set<std::uint64_t> seen;
    std::uint64_t near = random() % 3000;
    for (int i = 0; i < 5000; ++i) {
      if (random() % 500 == 0) near += random() % (3 * ReplayWindow::kWidth);
      near += random() % 4;
      const std::uint64_t back = random() % (ReplayWindow::kWidth + 200);
      const std::uint64_t number = near - std::min(near, random() % 2 == 0 ? back : back % 8);
      const bool newest = seen.empty() || number > *seen.rbegin();
      const bool young = newest || *seen.rbegin() - number < ReplayWindow::kWidth;
      const bool expected = young && seen.count(number) == 0;
      REQUIRE(window.fresh(number) == expected);
      if (!expected) continue;
      REQUIRE(window.take(number) == newest);
      seen.insert(number);
    }
  }
}
