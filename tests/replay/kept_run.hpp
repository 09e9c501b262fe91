#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "simulation/step/simulation.hpp"
#include "tests/support/temporary_folder.hpp"
#include "trace/recording.hpp"
#include "trace/trace_writer.hpp"

namespace irdm::test {

/// A run that a test has made, as it was and as its trace has it.
class KeptRun {
 public:
  explicit KeptRun(SimulationConfig scene) : config(std::move(scene)) {
    for (std::size_t i = 0; i < config.objects.size(); ++i) {
      names.push_back("cube" + std::to_string(i));
    }
  }

  /// The step that has just been made.
  void keep(const Simulation& simulation, const StepRecord& record) {
    records.push_back(record);
    std::vector<Points>& surfaces = displacements.emplace_back(config.objects.size());
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
      simulation.object(static_cast<int>(i)).engine().displacement(surfaces[i]);
    }
  }

  /// Writes them and reads them back.
  Recording recording() const {
    TraceHeader header{{},
                       "scene",
                       config.objects[0].model->dt,
                       static_cast<int>(config.styluses.size()),
                       config.floor.has_value(),
                       touches_bodies(config),
                       {},
                       config.sleep_time > 0};
    for (const std::string& name : names) header.objects.push_back({name, "cube.h5", "sum"});
    const TemporaryFolder folder;
    const std::filesystem::path path = folder.path() / "trace.h5";
    TraceWriter writer(path, header);
    writer.append(records);
    writer.close();
    return {path, config, names};
  }

  SimulationConfig config;
  std::vector<std::string> names;
  std::vector<StepRecord> records;
  std::uint64_t limited = 0;  ///< Simulation::limited() at the end, where a test sets it
  std::vector<std::vector<Points>> displacements;  ///< of each step, of each object [m], B
};

}  // namespace irdm::test
