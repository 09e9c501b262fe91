// Runs a scene file of irdm-server without the server: its objects for a second, with nobody
// touching them, recorded as a trace that irdm-replay and Python read.
//   scene SCENE.toml TRACE.h5
#include <cstdio>
#include <exception>
#include <memory>
#include <vector>

#include "common/checksum.hpp"
#include "scene/scene.hpp"
#include "simulation/step/simulation.hpp"
#include "trace/trace_writer.hpp"

namespace {

irdm::TraceHeader header_of(const char* file, const irdm::SceneConfig& scene,
                            const irdm::SimulationConfig& config) {
  irdm::TraceHeader header;
  for (const irdm::ObjectConfig& object : scene.objects) {
    header.objects.push_back(
        {object.name, object.model.filename().string(), irdm::sha256_of_file(object.model)});
  }
  header.scene = irdm::read_text(file);
  header.dt = config.objects.front().model->dt;
  header.stylus_count = static_cast<int>(scene.styluses.size());
  header.floor = scene.floor.has_value();
  header.bodies = irdm::touches_bodies(config);
  header.tools = irdm::tool_styluses(config);
  header.sleep = config.sleep_time > 0;
  return header;
}

void run(const char* file, const char* trace) {
  const irdm::SceneConfig scene = irdm::read_scene(irdm::TomlTable::parse_file(file));
  const irdm::SimulationConfig config = irdm::simulation_config(scene, false);
  irdm::Simulation simulation(config);
  irdm::TraceWriter writer(trace, header_of(file, scene, config));
  const std::vector<irdm::StylusCommand> nobody(scene.styluses.size());
  auto record = std::make_unique<irdm::StepRecord>();
  while (static_cast<double>(simulation.next_step()) * simulation.dt() < 1.0) {
    simulation.step(nobody, *record);
    writer.append({record.get(), 1});
  }
  writer.close();
  std::printf("%llu steps\n", static_cast<unsigned long long>(simulation.next_step()));
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 3) return std::fputs("usage: scene SCENE.toml TRACE.h5\n", stderr), 2;
  run(argv[1], argv[2]);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "scene: error: %s\n", error.what());
  return 1;
}
