#include <cmath>

#include "precompute/check/step_error.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/led_brick.hpp"

using namespace irdm;
using namespace irdm::precompute;
using namespace irdm::test;

TEST_CASE("what a step costs in force is what a simulation of the brick pays", "[slow]") {
  const Vector3 top(0.01, 0.01, 0.03);
  const auto model = soft_brick(2e5, 2e-3);
  int node = 0;
  const auto away = [&](int i) { return (model->mesh.rest_position(i) - top).norm(); };
  for (int i = 0; i < model->mesh.surface_node_count(); ++i) {
    if (away(i) < away(node)) node = i;
  }
  const double reckoned = step_error(*model, node, 1.0);
  const double played = brick_error(brick_forces({BrickMotion::kPush, 2e5}, kFineStep),
                                    brick_forces({BrickMotion::kPush, 2e5}, 2e-3), 2e-3);
  CAPTURE(reckoned, played);
  // Another direction of the push, and 0.1 s less of it.
  CHECK(reckoned > 0.3 * played);
  CHECK(reckoned < 3.0 * played);
}

TEST_CASE("the step costs little in a soft body and much in a stiff one") {
  const auto model = soft_brick(2e3, 2e-3);
  CHECK(step_error(*model, 0, 1.0) < 0.02);
  CHECK(step_error(*model, 0, 0.25) < 0.02);
  CHECK(step_error(*model, 0, 100.0) > 0.1);
  const double factor = stiffness_for_error(*model, 0, 0.1);
  CHECK(step_error(*model, 0, factor) < 0.1);
  CHECK(step_error(*model, 0, 1.2 * factor) > 0.08);
}

TEST_CASE("a factor on the stiffness is the stiffer model") {
  const auto soft = soft_brick(2e4, 2e-3);
  const auto stiff = soft_brick(1.6e5, 2e-3);
  CHECK(step_error(*soft, 5, 8.0) == Approx(step_error(*stiff, 5, 1.0)).epsilon(1e-9));
}
