#pragma once

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
  SceneConfig scene_;
  SimulationConfig config_;
  std::unique_ptr<Simulation> simulation_;
  ContactRows rows_;
  std::unique_ptr<StepRecord> record_;
  std::span<const ContactRow> contacts_;
};

}  // namespace irdm
