#pragma once

#include <memory>
#include <vector>

#include "replay/made_again/forced_body.hpp"
#include "replay/made_again/made_again.hpp"
#include "simulation/step/simulation_config.hpp"

namespace irdm::replay {

/// What the recorded forces do: deformation and motion of the objects. Contacts, tips and proxies
/// are those of the trace.
class FromForces final : public MadeAgain {
 public:
  /// By the objects' responses: the forces keep their components in B.
  explicit FromForces(const SimulationConfig& config);
  /// @param objects one for each of the scene
  FromForces(const SimulationConfig& config, std::vector<std::unique_ptr<ForcedBody>> objects);

  void step(const StepRecord& recorded, StepRecord& again) override;
  void displacement(std::size_t i, Points& u) const override { objects_[i]->displacement(u); }

 private:
  void write_floor_and_styluses(StepRecord& again) const;

  SimulationConfig config_;
  std::vector<std::unique_ptr<ForcedBody>> objects_;
  Settings settings_;
};

}  // namespace irdm::replay
