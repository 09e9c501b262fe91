// How long one force step takes, and whether that depends on the object: cubes of growing size, one
// stylus that holds a point between three nodes, after T steps of history.
//   modal, fixed     the same number of modes at every size
//   modal, all       as many modes as a cube of that size has
//   dense            R itself, as far as memory goes
// The responses are synthetic (random shapes): the time does not depend on the numbers.

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include "bench/statistics.hpp"
#include "server/step/simulation.hpp"
#include "tests/support/synthetic_model.hpp"

using namespace irdm;

namespace {

constexpr int kSteps = 500;  // T
constexpr int kFixedModes = 500;
constexpr int kMeasured = 4000;

struct Timing {
  double median = 0.0;  ///< [us]
  double p99 = 0.0;     ///< [us]
};

Timing measure(std::shared_ptr<const Model> model) {
  SimulationConfig config;
  config.objects.resize(1);
  config.objects[0].model = std::move(model);
  Simulation simulation(config);
  StepRecord record;
  std::vector<double> times;
  for (int k = 0; k < kSteps + kMeasured; ++k) {
    const double t = k * simulation.dt();
    const double height = k < 2 ? 0.061 : 0.059;
    // A place between nodes at every size, moved a little to and fro.
    const StylusCommand command{
        true, kGrabButton, {0.0013 + 0.001 * std::sin(9.0 * t), height, 0.0011}, {}};
    const double time = bench::seconds([&] { simulation.step({&command, 1}, record); });
    if (k >= kSteps) times.push_back(1e6 * time);
  }
  if (record.stylus[0].contact != ContactState::kHeld) {
    std::fprintf(stderr, "bench: the stylus lost its hold; these times mean nothing\n");
    std::exit(1);
  }
  return {bench::percentile(times, 0.5), bench::percentile(times, 0.99)};
}

// Numbers of any kind; only their place matters.
Model dense_model(int cells) {
  Model model = test::synthetic_cube(cells, 1, kSteps);
  const auto dof = static_cast<std::size_t>(model.degrees_of_freedom());
  std::vector<float> values(dof * dof * kSteps);
  for (std::size_t b = 0; b < dof; ++b) {
    for (std::size_t s = 0; s < kSteps; ++s) {
      for (std::size_t a = 0; a < dof; ++a) {
        const double near = a == b ? 1e-3 : 1e-6;
        values[(b * dof + a) * kSteps + s] =
            static_cast<float>(near * std::exp(-0.01 * static_cast<double>(s)));
      }
    }
  }
  model.response = DenseResponse{static_cast<int>(dof), kSteps, std::move(values)};
  return model;
}

double dense_gigabytes(int nodes) {
  return 9.0 * nodes * nodes * kSteps * sizeof(float) / 1e9;
}

}  // namespace

int main(int argc, char** argv) {
  const double limit = argc > 1 ? std::atof(argv[1]) : 3.0;
  std::printf("force step with one held contact, T = %d; dense up to %.1f GB\n\n", kSteps, limit);
  std::printf(
      "| surface nodes | modal, %d modes: median, p99 [us] | modal, all modes | median, p99 [us] "
      "| dense [GB] | median, p99 [us] |\n|---|---|---|---|---|---|\n",
      kFixedModes);
  for (const int cells : {5, 8, 12, 16, 20, 24}) {
    const int nodes = 6 * cells * cells + 2;
    const int all =
        3 * static_cast<int>(std::pow(cells + 1, 3) * 0.615) - 6;  // as TetGen fills the cube
    const Timing fixed =
        measure(std::make_shared<const Model>(test::synthetic_cube(cells, kFixedModes, kSteps)));
    std::printf("| %d | %.1f, %.1f |", nodes, fixed.median, fixed.p99);
    if (cells <= 16) {
      const Timing whole =
          measure(std::make_shared<const Model>(test::synthetic_cube(cells, all, kSteps)));
      std::printf(" %d | %.1f, %.1f |", all, whole.median, whole.p99);
    } else {
      std::printf(" | |");
    }
    if (dense_gigabytes(nodes) <= limit) {
      const Timing dense = measure(std::make_shared<const Model>(dense_model(cells)));
      std::printf(" %.1f | %.1f, %.1f |\n", dense_gigabytes(nodes), dense.median, dense.p99);
    } else {
      std::printf(" %.1f | not measured |\n", dense_gigabytes(nodes));
    }
    std::fflush(stdout);
  }
}
