// Up to which delay an object of a stiffness is shown faithfully: bench_faithful_loops. A cube is
// pressed from above (at home by its tether), or held at a point and swung; without safety filter.
// Largest difference of the force to the loop without delay, as a share of its peak, for each
// stiffness and delay one way; with forces held and with the contact at the bridge.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "tests/prediction/delayed_loop.hpp"
#include "tests/support/fem_cube.hpp"

using namespace irdm;
using namespace irdm::test;

namespace {

constexpr double kHalfEdge = 0.06;
constexpr std::array kStiffnesses{1e3, 3e3, 1e4, 3e4, 1e5, 1e6};
constexpr std::array kDelays{0.002, 0.004, 0.006, 0.01, 0.02};

double smooth(double t, double from, double to) {
  const double s = std::clamp((t - from) / (to - from), 0.0, 1.0);
  return s * s * (3 - 2 * s);
}

LoopSetup cube(double youngs_modulus) {
  LoopSetup setup;
  setup.config.objects.resize(1);
  setup.config.objects[0].model =
      fem_cube({.cells = 3, .youngs_modulus = youngs_modulus}, ResponseKind::kModal);
  setup.config.objects[0].friction = {0.6, 0.5};
  setup.config.styluses = {{0.0, 2000.0, 0.005}};
  return setup;
}

LoopSetup pressed(double youngs_modulus) {
  LoopSetup setup = cube(youngs_modulus);
  setup.config.objects[0].tether = {1000.0, 10.0};
  setup.config.objects[0].damping = {20.0, 20.0};
  setup.hands.push_back({.target = [](double t) {
    const double down = 0.02 * (smooth(t, 0.1, 0.6) - smooth(t, 2.2, 2.6));
    return Vector3(0, kHalfEdge + 0.005 - down, 0.01);
  }});
  return setup;
}

LoopSetup swung(double youngs_modulus) {
  LoopSetup setup = cube(youngs_modulus);
  setup.hands.push_back({.target =
                             [](double t) {
                               const double share = 0.05 * smooth(t, 0.1, 0.4);
                               const double way = share * std::sin(2 * M_PI * 1.5 * (t - 0.1));
                               return Vector3(way, kHalfEdge, 0);
                             },
                         .grab = true});
  return setup;
}

void report(const char* name, LoopSetup (*make)(double), LoopMode mode) {
  std::printf("%s\n  E [N/m^2], error of the force at a delay of", name);
  for (const double delay : kDelays) std::printf(" %g", 1e3 * delay);
  std::printf(" ms one way\n");
  for (const double stiffness : kStiffnesses) {
    const LoopSetup setup = make(stiffness);
    const LoopRun direct = run_loop(setup, LoopMode::kDirect);
    std::printf("  %8g", stiffness);
    for (const double delay : kDelays) {
      std::printf("  %9.3g", largest_error(run_loop(setup, mode, {.delay = delay}), direct));
    }
    std::printf("\n");
  }
}

}  // namespace

int main() {
  report("pressed, forces held", pressed, LoopMode::kHold);
  report("swung, forces held", swung, LoopMode::kHold);
  report("pressed, contact at the bridge", pressed, LoopMode::kPredict);
  report("swung, contact at the bridge", swung, LoopMode::kPredict);
}
