#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "replay/rerun/forced_object.hpp"
#include "simulation/step/simulation.hpp"
#include "simulation/step/simulation_config.hpp"
#include "simulation/step/step_record.hpp"
#include "trace/recording.hpp"

namespace irdm::replay {

/// A force that a bridge told of after its step.
struct DelayedForces {
  std::size_t step = 0;  ///< that it belongs to, from the start of the trace
  LateForce late;
  Quaternion orientation =
      Quaternion::Identity();  ///< of the recorded body half-way through that step
};

/// What bridges told too late, by the steps that it belongs to. What belongs to a time before the
/// trace, or before a reset, is left out, as in the server.
std::vector<DelayedForces> delayed_forces(const Recording& recording);

/// What acted on the styluses in the end: adds to their forces what was told late for a step.
/// @param told of delayed_forces()  @param step of the trace, that the record is of
/// @param held_anew the forces of what is held were found anew, so that they have it already
void add_delayed_forces(const std::vector<DelayedForces>& told, std::size_t step, bool held_anew,
                        StepRecord& record);

/// A recorded run, computed again step by step. Pure; one thread.
class Rerun {
 public:
  virtual ~Rerun() = default;

  /// The next step. @param recorded as it is in the trace @param again as it comes out now
  virtual void step(const StepRecord& recorded, StepRecord& again) = 0;

  /// Of all surface nodes of object i at the end of the last step, (n, 3) [m], B.
  virtual void displacement(std::size_t i, Points& u) const = 0;
};

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
