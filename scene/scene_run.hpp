#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "common/config/toml_reader.hpp"
#include "scene/scene.hpp"
#include "simulation/step/simulation.hpp"
#include "simulation/step/step_rows.hpp"

namespace irdm {

/// What is wrong with a command, in words; null: nothing. A tip has to be finite and within
/// lab::kPlace, an orientation of length 1. Real-time safe.
const char* fault_of(const StylusCommand& command) noexcept;

/// A scene that another program steps by itself: no server, no clock, no thread. What irdm-server
/// computes in lockstep from the same commands, to the bit. [server] and [viewer] mean nothing, and
/// objects with a memory_budget are read whole. One thread at a time.
class SceneRun {
 public:
  /// Reads models and places objects. Throws Error.
  explicit SceneRun(const TomlTable& file);

  /// The next step of dt. Real-time safe.
  /// @param commands one a stylus, with which nothing is wrong
  const StepRecord& step(std::span<const StylusCommand> commands) noexcept;
  /// Everything is put back to the start before the next step.
  void reset() noexcept { simulation_->reset(); }

  /// Of the last step; as in StepRecord. Valid until the next one.
  const StepRecord& record() const noexcept { return *record_; }
  std::span<const ContactRow> contacts() const noexcept { return contacts_; }
  std::span<const ObjectRow> objects() const noexcept { return objects_; }

  /// The state, of some kilobytes an object; with a dense response all forces that it has not
  /// forgotten, besides. For this version of irdm on this kind of machine.
  std::vector<std::byte> save_state() const;
  /// The simulation goes on from a state as the one that it was saved from, to the bit, the last
  /// step's record included. Throws Error, and leaves all as it is, where the state is of another
  /// scene or version, or damaged. Models, styluses, objects and scenery have to be the same; their
  /// other keys are not looked at.
  void load_state(std::span<const std::byte> state);

  /// From the next step on [m/s^2], W. Throws Error where it is not within 100 m/s^2.
  void set_gravity(const Vector3& gravity);

  /// Where the surface nodes of object i are at the end of the last step, (n, 3) [m], W. Uses
  /// OpenMP; not real-time safe.
  void surface(int i, Points& x) const;

  const Simulation& simulation() const noexcept { return *simulation_; }
  const std::shared_ptr<const Model>& model(int i) const {
    return config_.objects[static_cast<std::size_t>(i)].model;
  }
  const SceneConfig& scene() const noexcept { return scene_; }
  int stylus_count() const noexcept { return static_cast<int>(scene_.styluses.size()); }

 private:
  void archive(StateArchive& state) const;
  void describe() noexcept;

  SceneConfig scene_;
  SimulationConfig config_;
  std::unique_ptr<Simulation> simulation_;
  ContactRows rows_;
  std::unique_ptr<StepRecord> record_;
  std::span<const ContactRow> contacts_;
  std::vector<ObjectRow> objects_;
  std::string identity_;  ///< of models and program, in a state
};

}  // namespace irdm
