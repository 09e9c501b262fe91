#pragma once

#include <memory>
#include <vector>

#include "replay/made_again/forced_object.hpp"
#include "replay/made_again/made_again.hpp"

namespace irdm::replay {

/// What the recorded forces do: deformation and motion of the objects. Contacts, tips and proxies
/// are those of the trace; the forces keep their components in B.
class FromForces final : public MadeAgain {
 public:
  explicit FromForces(const SimulationConfig& config);

  void step(const StepRecord& recorded, StepRecord& again) override;
  void displacement(std::size_t i, Points& u) const override {
    objects_[i]->engine().displacement(u);
  }

 private:
  void write_floor_and_styluses(StepRecord& again) const;

  SimulationConfig config_;
  std::vector<std::unique_ptr<ForcedObject>> objects_;
  Settings settings_;
};

}  // namespace irdm::replay
