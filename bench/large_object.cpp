// What a large object costs while it is rendered: bench_large_object MODEL.h5. A fingertip of 1.5
// cm presses on its top and slides to and fro; then the surface, frame by frame.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "bench/statistics.hpp"
#include "common/model/model_file.hpp"
#include "simulation/engine/response_engine.hpp"
#include "simulation/step/simulation.hpp"

using namespace irdm;

namespace {

constexpr int kSettling = 500;
constexpr int kMeasured = 3000;
constexpr int kFrames = 200;

SimulationConfig scene(std::shared_ptr<const Model> model, int styluses) {
  SimulationConfig config;
  config.objects.resize(1);
  config.objects[0].model = std::move(model);
  config.objects[0].friction = {0.5, 0.4};
  config.objects[0].tether = {1000.0, 10.0};
  config.objects[0].damping = {20.0, 20.0};
  config.styluses.assign(static_cast<std::size_t>(styluses), {0.015, 2000.0, 0.0});
  return config;
}

// Down on the top within 0.2 s, or up on the bottom, then to and fro.
StylusCommand command(int k, double height, double way) {
  const double down = std::min(1.0, k / 100.0);
  return {true, 0u, {0.01 * std::sin(0.01 * k), way * (height + 0.002 - 0.008 * down), 0.003}, {}};
}

void measure_steps(const std::shared_ptr<const Model>& model, double height, int styluses) {
  Simulation simulation(scene(model, styluses));
  StepRecord record;
  std::vector<double> times;
  int touching = 0;
  for (int k = 0; k < kSettling + kMeasured; ++k) {
    std::vector<StylusCommand> commands{command(k, height, 1.0)};
    if (styluses > 1) commands.push_back(command(k, height, -1.0));
    const double time = bench::seconds([&] { simulation.step(commands, record); });
    if (k < kSettling) continue;
    times.push_back(1e6 * time);
    touching += record.stylus[0].contact == ContactState::kTouching ? 1 : 0;
  }
  std::printf("| force step, %d fingertip(s), touching in %.0f %% | %.0f us | %.0f us |\n",
              styluses, 100.0 * touching / kMeasured, bench::percentile(times, 0.5),
              bench::percentile(times, 0.99));
}

void measure_frames(const std::shared_ptr<const Model>& model) {
  const auto engine = make_engine(model);
  Points u;
  std::vector<double> times;
  for (int k = 0; k < kFrames; ++k) {
    const NodalForce force{k % model->mesh.surface_node_count(), Vector3(0.0, -0.1, 0.0)};
    engine->advance({&force, 1});
    times.push_back(1e3 * bench::seconds([&] { engine->displacement(u); }));
  }
  std::printf("| surface | %.2f ms | %.2f ms |\n", bench::percentile(times, 0.5),
              bench::percentile(times, 0.99));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: bench_large_object MODEL.h5\n");
    return 2;
  }
  const auto model = std::make_shared<const Model>(read_model(argv[1], ResponseKind::kModal));
  const auto& response = std::get<ModalResponse>(model->response);
  std::printf("%ld tetrahedra, %d surface nodes, %d modes, %zu blocks of residual compliance\n\n",
              static_cast<long>(model->mesh.tets.rows()), model->mesh.surface_node_count(),
              response.mode_count(), response.residual.nodes.size());
  double height = 0.0;
  for (int i = 0; i < model->mesh.surface_node_count(); ++i) {
    height = std::max(height, model->mesh.rest_position(i).y());
  }
  std::printf("| | median | p99 |\n|---|---|---|\n");
  measure_steps(model, height, 1);
  measure_steps(model, height, 2);
  measure_frames(model);
  return 0;
}
