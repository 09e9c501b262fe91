#include "common/error.hpp"
#include "replay/replay.hpp"
#include "tests/support/catch.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::replay;

TEST_CASE("every step is a frame without a rate, and at that of the steps") {
  for (const std::optional<double> rate : {std::optional<double>{}, std::optional<double>{500.0}}) {
    const FrameSteps frames(1050, 0.002, rate);
    CHECK(frames.count() == 1050);
    for (std::size_t k = 0; k < 1050; ++k) REQUIRE(frames.has(k));
  }
}

TEST_CASE("a frame is at the end of the step that its time falls into") {
  const double rate = GENERATE(1.0, 24.0, 60.0, 250.0, 333.3, 499.0);
  constexpr double kDt = 0.002;
  constexpr std::size_t kSteps = 1050;
  const FrameSteps frames(kSteps, kDt, rate);
  std::size_t next = 0;
  for (std::size_t k = 0; k < kSteps; ++k) {
    if (!frames.has(k)) continue;
    ++next;
    const double time = static_cast<double>(next) / rate;
    REQUIRE(time > static_cast<double>(k) * kDt - 1e-8);
    REQUIRE(time <= static_cast<double>(k + 1) * kDt + 1e-8);
  }
  CHECK(next == frames.count());
  CHECK(next == static_cast<std::size_t>(kSteps * kDt * rate + 1e-6));
}

TEST_CASE("there are no more frames than steps") {
  CHECK_THROWS_WITH(FrameSteps(100, 0.002, 501.0), ContainsSubstring("at most 500"));
}

TEST_CASE("frames of a part of a run are those of the whole run that are in it") {
  const FrameSteps whole(1050, 0.002, 60.0);
  const FrameSteps part(1050, 0.002, 60.0, {0.5, 1.0});
  CHECK(whole.steps() == 1050);
  CHECK(part.steps() == 500);
  std::size_t count = 0;
  for (std::size_t k = 0; k < 1050; ++k) {
    const double end_of_step = 0.002 * static_cast<double>(k + 1);
    const bool within = end_of_step > 0.5 - 1e-9 && end_of_step < 1.0 + 1e-9;
    REQUIRE(part.has(k) == (within && whole.has(k)));
    count += part.has(k) ? 1 : 0;
  }
  CHECK(part.count() == count);
  CHECK(count > 25);
  CHECK(FrameSteps(10, 0.002, std::nullopt, {0.0, 0.002}).count() == 1);
  CHECK_THROWS_WITH(FrameSteps(10, 0.002, std::nullopt, {1.0}), ContainsSubstring("0.02"));
}
