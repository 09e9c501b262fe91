// What a contact that is solved at its bridge costs the server after each step: prediction for
// one held stylus, beside the step itself, as it goes on from step to step and after a late force,
// which makes it compute all anew; and entering that force. Cubes of growing size with
// all their modes, and the smaller ones with R itself; the responses are synthetic (random shapes).

#include <cmath>
#include <cstdio>
#include <memory>

#include "bench/statistics.hpp"
#include "common/contact/contact_model.hpp"
#include "simulation/step/simulation.hpp"
#include "tests/support/synthetic_model.hpp"

using namespace irdm;

namespace {

constexpr int kSteps = 500;
constexpr int kMeasured = 2000;
constexpr int kHorizon = 25;

void measure(const char* engine, int modes, Model model) {
  SimulationConfig config;
  config.objects.resize(1);
  config.objects[0].model = std::make_shared<const Model>(std::move(model));
  Simulation simulation(config);
  StepRecord record;
  ContactModel contact;
  std::vector<double> step;
  std::vector<double> ahead;
  std::vector<double> anew;
  std::vector<double> late;
  for (int k = 0; k < kSteps + kMeasured; ++k) {
    const double height = k < 2 ? 0.061 : 0.059;
    const StylusCommand command{
        true, kGrabButton, {0.0013 + 0.001 * std::sin(0.018 * k), height, 0.0011}, {}};
    step.push_back(1e6 * bench::seconds([&] { simulation.step({&command, 1}, record); }));
    const bool after_late = k % 4 == 0;
    const double time = 1e6 * bench::seconds([&] {
                          simulation.predict_horizon(0, command.tip, kHorizon, contact);
                        });
    if (k >= kSteps) (after_late ? anew : ahead).push_back(time);
    if (k % 4 != 3) continue;
    late.push_back(1e6 * bench::seconds([&] {
                     simulation.insert_delayed_force(0, {Vector3(0, -1e-6, 0), command.tip}, 3);
                   }));
  }
  std::printf("| %s | %d | %d |", engine, config.objects[0].model->mesh.surface_node_count(),
              modes);
  step.erase(step.begin(), step.begin() + kSteps);  // until the history is full
  late.erase(late.begin(), late.begin() + kSteps / 4);
  for (auto* times : {&step, &ahead, &anew, &late}) {
    std::printf(" %.1f, %.1f |", bench::percentile(*times, 0.5), bench::percentile(*times, 0.99));
  }
  std::printf("\n");
}

}  // namespace

int main() {
  std::printf("looking %d steps ahead, one held contact; median, p99 [us]\n\n", kHorizon);
  std::printf(
      "| engine | surface nodes | modes | step | prediction | after a late force | a late force |\n"
      "|---|---|---|---|---|---|---|\n");
  for (const int cells : {5, 8, 12, 16}) {
    const int modes = 3 * static_cast<int>(std::pow(cells + 1, 3) * 0.615) - 6;
    Model modal = test::synthetic_cube(cells, modes, kSteps);
    if (cells <= 8) measure("dense", modes, test::with_dense_response<float>(modal));
    measure("modal", modes, std::move(modal));
  }
}
