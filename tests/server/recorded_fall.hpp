#pragma once

#include <filesystem>

#include "simulation/deformation/deformation.hpp"
#include "simulation/step/simulation.hpp"
#include "tests/server/two_cubes.hpp"
#include "trace/trace_writer.hpp"

namespace irdm::test {

/// The surface after every step, as the deformation of the run itself has it.
struct RecordedFall {
  static constexpr int kSteps = 160;
  RecordedFall(const std::filesystem::path& path, std::size_t objects) : config(two_cubes()) {
    config.objects.resize(objects);
    TraceHeader header{{}, "scene", 0.002, 2, true, touches_bodies(config)};
    for (std::size_t i = 0; i < objects; ++i) {
      names.push_back("cube" + std::to_string(i));
      header.objects.push_back({names.back(), "cube.h5", "sum"});
    }
    Simulation simulation(config);
    Deformation deformation(config);
    std::vector<StepRecord> records(kSteps);
    for (int k = 0; k < kSteps; ++k) {
      StepRecord& record = records[static_cast<std::size_t>(k)];
      play_step(simulation, k, record);
      deformation.follow(record);
      SurfaceFrame& frame = frames.emplace_back(rest_frame(config));
      deformation.compute(frame);
      for (std::size_t i = 0; i < objects; ++i) {
        Points displacement;
        simulation.object(static_cast<int>(i)).engine().displacement(displacement);
        off_the_step = std::max(
            off_the_step, (frame.objects[i].displacement - displacement).cwiseAbs().maxCoeff());
      }
      late += record.late.count;
    }
    TraceWriter writer(path, header);
    writer.append(records);
    writer.close();
  }

  SimulationConfig config;
  std::vector<std::string> names;
  std::vector<SurfaceFrame> frames;
  double off_the_step = 0.0;  ///< largest difference from what the force step itself has [m]
  std::size_t late = 0;       ///< forces that were entered late
};

}  // namespace irdm::test
