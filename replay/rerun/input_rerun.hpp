#pragma once

#include <optional>

#include "replay/rerun/rerun.hpp"
#include "simulation/step/simulation.hpp"

namespace irdm::replay {

/// The whole force step once more: contacts, forces and motion from where the styluses were, what
/// their buttons did, what was set, and what bridges that solved contacts themselves told.
class InputRerun final : public Rerun {
 public:
  /// Throws Error, as Simulation does.
  /// @param solve_bridged contacts that bridges solved are solved here, as if nothing was told
  explicit InputRerun(const SimulationConfig& config, bool solve_bridged = false);

  void step(const StepRecord& recorded, StepRecord& again) override;
  void displacement(std::size_t i, Points& u) const override {
    simulation_.object(static_cast<int>(i)).engine().displacement(u);
  }

 private:
  void insert_delayed_force(const StepRecord& recorded);

  SimulationConfig config_;
  bool solve_bridged_;
  Simulation simulation_;
};

}  // namespace irdm::replay
