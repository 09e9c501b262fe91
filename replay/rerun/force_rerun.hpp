#pragma once

#include <memory>
#include <vector>

#include "replay/rerun/forced_body.hpp"
#include "replay/rerun/rerun.hpp"
#include "simulation/step/simulation_config.hpp"

namespace irdm::replay {

/// What the recorded forces do: deformation and motion of the objects. Contacts, tips and proxies
/// are those of the trace.
class ForceRerun final : public Rerun {
 public:
  /// By the objects' responses: the forces keep their components in B.
  explicit ForceRerun(const SimulationConfig& config);
  /// @param objects one for each of the scene
  ForceRerun(const SimulationConfig& config, std::vector<std::unique_ptr<ForcedBody>> objects);

  void step(const StepRecord& recorded, StepRecord& again) override;
  void displacement(std::size_t i, Points& u) const override { objects_[i]->displacement(u); }

 private:
  void write_floor_and_styluses(StepRecord& again) const;

  SimulationConfig config_;
  std::vector<std::unique_ptr<ForcedBody>> objects_;
  Settings settings_;
};

}  // namespace irdm::replay
