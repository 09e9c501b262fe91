#include "common/realtime/histogram.hpp"
#include "tests/support/catch.hpp"

using irdm::Histogram;

TEST_CASE("histogram of nothing is zero") {
  const Histogram histogram;
  CHECK(histogram.count() == 0);
  CHECK(histogram.percentile(0.5) == 0);
  CHECK(histogram.maximum() == 0);
}

TEST_CASE("histogram percentiles are within a bucket's width of the exact ones") {
  Histogram histogram;
  constexpr std::int64_t kCount = 100'000;
  for (std::int64_t i = 1; i <= kCount; ++i) histogram.add(i * 37);
  CHECK(histogram.maximum() == kCount * 37);
  for (const double fraction : {0.01, 0.5, 0.9, 0.99, 1.0}) {
    const double exact = fraction * static_cast<double>(kCount) * 37.0;
    CHECK(static_cast<double>(histogram.percentile(fraction)) == Approx(exact).epsilon(0.035));
  }
}

TEST_CASE("histogram keeps what is out of range") {
  Histogram histogram;
  histogram.add(-5);
  histogram.add(std::int64_t{1} << 60);
  CHECK(histogram.count() == 2);
  CHECK(histogram.percentile(0.5) == 0);
  CHECK(histogram.maximum() == std::int64_t{1} << 60);
}

TEST_CASE("histogram tells the share up to a limit") {
  Histogram histogram;
  CHECK(histogram.share_up_to(1'000'000) == 0.0);
  for (std::int64_t ms = 1; ms <= 100; ++ms) histogram.add(ms * 1'000'000);
  CHECK(histogram.share_up_to(-1) == 0.0);
  CHECK(histogram.share_up_to(500'000) == 0.0);
  CHECK(histogram.share_up_to(50'000'000) == Approx(0.5).margin(0.02));
  CHECK(histogram.share_up_to(100'000'000) == 1.0);
}
