// What a contact that is solved at its bridge costs the server after each step: looking ahead for
// one held stylus, beside the step itself, and entering a late force. Cubes of growing size with
// all their modes; the responses are synthetic (random shapes).

#include <cmath>
#include <cstdio>
#include <memory>

#include "bench/statistics.hpp"
#include "common/contact/contact_model.hpp"
#include "server/step/simulation.hpp"
#include "tests/support/synthetic_model.hpp"

using namespace irdm;

int main() {
  constexpr int kMeasured = 2000;
  constexpr int kHorizon = 25;
  std::printf("looking %d steps ahead, one held contact; median, p99 [us]\n\n", kHorizon);
  std::printf(
      "| surface nodes | modes | step | looking ahead | a late force |\n|---|---|---|---|---|\n");
  for (const int cells : {5, 8, 12, 16}) {
    const int modes = 3 * static_cast<int>(std::pow(cells + 1, 3) * 0.615) - 6;
    SimulationConfig config;
    config.objects.resize(1);
    config.objects[0].model =
        std::make_shared<const Model>(test::synthetic_cube(cells, modes, 500));
    Simulation simulation(config);
    StepRecord record;
    ContactModel model;
    std::vector<double> step;
    std::vector<double> ahead;
    std::vector<double> late;
    for (int k = 0; k < kMeasured; ++k) {
      const double height = k < 2 ? 0.061 : 0.059;
      const StylusCommand command{
          true, kGrabButton, {0.0013 + 0.001 * std::sin(0.018 * k), height, 0.0011}, {}};
      step.push_back(1e6 * bench::seconds([&] { simulation.step({&command, 1}, record); }));
      ahead.push_back(1e6 *
                      bench::seconds([&] { simulation.foresee(0, command.tip, kHorizon, model); }));
      late.push_back(1e6 * bench::seconds([&] {
                       simulation.enter_late(0, {Vector3(0, -1e-6, 0), command.tip}, 3);
                     }));
    }
    std::printf("| %d | %d |", 6 * cells * cells + 2, modes);
    for (auto* times : {&step, &ahead, &late}) {
      std::printf(" %.1f, %.1f |", bench::percentile(*times, 0.5), bench::percentile(*times, 0.99));
    }
    std::printf("\n");
  }
}
