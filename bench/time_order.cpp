// How the force goes with the step: bench_time_order. One line for each motion of a stylus on a
// soft brick, stiffness and step: the largest error of the force against steps of 0.1 ms, as a
// share of its peak. scripts/plot_time_order.py draws it.

#include <array>
#include <cstdio>
#include <utility>

#include "tests/support/led_brick.hpp"

using namespace irdm;
using namespace irdm::test;

int main() {
  constexpr std::array<std::pair<const char*, BrickMotion>, 4> kMotions{
      {{"swing", BrickMotion::kSwing},
       {"push", BrickMotion::kPush},
       {"tap", BrickMotion::kTap},
       {"slide", BrickMotion::kSlide}}};
  std::printf("motion,youngs_modulus,dt,error\n");
  for (const auto& [name, motion] : kMotions) {
    for (const double E : {2e3, 2e4, 2e5, 1e6}) {
      const std::vector<Vector3> fine = brick_forces(motion, E, kFineStep);
      for (const double dt : {4e-3, 2e-3, 1e-3, 5e-4, 2e-4}) {
        std::printf("%s,%g,%g,%.3e\n", name, E, dt,
                    brick_error(fine, brick_forces(motion, E, dt), dt));
        std::fflush(stdout);
      }
    }
  }
}
