// How the force on a stylus goes with the step, against the same at 0.1 ms.
#include <array>

#include "tests/support/catch.hpp"
#include "tests/support/led_brick.hpp"

using namespace irdm;
using namespace irdm::test;

TEST_CASE("time order: a node that is led is felt right at 2 ms, and second order in dt",
          "[slow]") {
  const BrickMotion motion = GENERATE(BrickMotion::kSwing, BrickMotion::kPush);
  const double E = GENERATE(2e3, 2e4);
  const std::vector<Vector3> fine = brick_forces({motion, E}, kFineStep);
  std::array<double, 3> error{};
  for (std::size_t i = 0; i < error.size(); ++i) {
    const double dt = 2e-3 / static_cast<double>(1 << i);
    error[i] = brick_error(fine, brick_forces({motion, E}, dt), dt);
  }
  CAPTURE(static_cast<int>(motion), E, error[0], error[1], error[2]);
  CHECK(error[0] < 0.02);
  CHECK(error[1] < 0.005);
  CHECK(error[1] < error[0] / 3.5);
  CHECK(error[2] < error[1] / 3.5);
}

TEST_CASE("time order: a stiff body that is led", "[slow]") {
  constexpr double kDt = 1e-3;
  const auto error = [&](BrickMotion motion) {
    return brick_error(brick_forces({motion, 2e5}, kFineStep), brick_forces({motion, 2e5}, kDt),
                       kDt);
  };
  CHECK(error(BrickMotion::kSwing) < 0.05);
  CHECK(error(BrickMotion::kPush) < 0.15);
}
