#pragma once

#include <array>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "common/contact/applied_forces.hpp"
#include "simulation/step/simulation_config.hpp"
#include "simulation/step/sleep.hpp"
#include "simulation/step/soft_object.hpp"
#include "simulation/step/step_record.hpp"
#include "simulation/step/tool_lead.hpp"
#include "simulation/step/world_contacts.hpp"

namespace irdm {

/// The force step of a scene: a pure function of the commands and of the state in here. It knows no
/// clock, thread, file or socket; the same commands give the same bits. Objects that touch each
/// other are solved together, the others by themselves; a stylus may touch several and feels the
/// sum. One thread; step() is real-time safe.
class Simulation {
 public:
  /// Throws Error when a model lacks the response that its engine needs, when models differ in dt,
  /// when damping, tether or a tool's coupling are too strong for it, when there are too many
  /// objects or styluses, or when bodies are inside one another.
  explicit Simulation(const SimulationConfig& config);

  /// Step k = 0, 1, ...: from time k dt to (k + 1) dt. Before it everything is reset to the
  /// start if `reset_first` says so or the reset button of a stylus has gone down since the step
  /// before. A stylus then has to come from outside, and press its grab button again, to touch or
  /// take hold.
  /// @param commands one a stylus
  void step(std::span<const StylusCommand> commands, StepRecord& record,
            bool reset_first = false) noexcept;

  /// Puts everything back to the start; the step number goes on. The record of the next step says
  /// so.
  void reset() noexcept;

  /// State, in or out (StateArchive), between steps, settings included: the steps that follow are
  /// the same to the bit. Forces of bridges on steps before it come too late then. Throws Error
  /// where the state is of another scene, with the simulation then half of each, and where an
  /// object's response is read from its file as it is needed. Not real-time safe.
  void archive(StateArchive& state);

  /// For the bridge of stylus s, between steps: how its contact goes on after the last step.
  /// @param tip where the stylus was in the last step [m], W
  /// @param horizon steps to predict, 1 to kMaxHorizon
  /// @param budget of computations that take long. For a contact 1 is all that is new, or has
  /// another contact in it; for a free tip the nearest point, a response and a path take 1 each.
  /// False: there was too little left, the model means nothing, and a later call goes on from there
  bool predict_horizon(std::size_t s, const Vector3& tip, int horizon, ContactModel& model,
                       int& budget) noexcept;
  void predict_horizon(std::size_t s, const Vector3& tip, int horizon,
                       ContactModel& model) noexcept {
    int budget = std::numeric_limits<int>::max();
    predict_horizon(s, tip, horizon, model, budget);
  }

  /// Between steps: stylus s exerted this force on the object, besides what is known, in the
  /// step `age` steps before the last one. False: that is too long ago, it touched
  /// nothing, or there are more of them than LateForces::kMost.
  bool insert_delayed_force(std::size_t s, const AppliedForce& applied, int age) noexcept;
  /// Between steps: the bridge of stylus s told late where its tip was in the step `age` steps
  /// before the last one. @param tip [m], W
  void tell_late(std::size_t s, const Vector3& tip, int age) noexcept;
  /// The same of a recorded one (StepRecord::late), when a run is rerun.
  bool insert_delayed_force(const LateForce& late) noexcept;
  /// How many more can be entered before the coming step.
  std::size_t late_room() const noexcept { return LateForces::kMost - late_.count; }
  /// The object that predict_horizon() last spoke of; -1: none.
  int local_model_object(std::size_t s) const noexcept { return local_model_object_[s]; }
  /// The last step before which everything was reset; 0: none.
  std::uint64_t reset_step() const noexcept { return reset_step_; }

  /// From the next step on. They must have passed check_settings(). Real-time safe.
  void set(const Settings& settings) noexcept;
  const Settings& settings() const noexcept { return settings_; }

  double dt() const noexcept { return dt_; }
  /// SimulationStylus::max_force of stylus s [N].
  double max_force(std::size_t s) const noexcept { return max_force_[s]; }
  /// The number of the coming step.
  std::uint64_t next_step() const noexcept { return next_step_; }
  /// Nodes that forces began to act on while their columns of R were not there, so far.
  std::uint64_t cache_misses() const noexcept;
  /// SoftObject::limited() of all objects.
  std::uint64_t limited() const noexcept;
  int object_count() const noexcept { return static_cast<int>(objects_.size()); }
  const SoftObject& object(int i = 0) const noexcept {
    return *objects_[static_cast<std::size_t>(i)];
  }

 private:
  void add_tool(const SimulationConfig& config, std::size_t s);
  void begin_objects(std::span<const StylusCommand> commands, StepRecord& record) noexcept;
  std::span<const StylusCommand> own_contacts(std::span<const StylusCommand> commands) noexcept;
  void grip(std::size_t s, const StylusCommand& command) noexcept;
  const StylusBall* ball(std::size_t s) const noexcept {
    return world_ ? world_->ball(s) : nullptr;
  }
  void write_tool(const ToolLead& lead, StylusRecord& stylus) const noexcept;
  int touched_by(std::size_t s, const Vector3& tip) noexcept;
  bool reset_pressed(std::span<const StylusCommand> commands) noexcept;
  void write_stylus(std::size_t s, const StylusCommand& command, StepRecord& record) const noexcept;

  double dt_ = 0.0;
  Settings settings_;
  std::uint32_t settings_change_ = 0;
  std::uint64_t next_step_ = 0;
  std::uint64_t reset_step_ = 0;
  bool was_reset_ = false;  ///< since the last step
  /// The reset button was down, or nobody there, in the last step.
  std::array<bool, kMaxStyluses> reset_down_;
  std::size_t stylus_count_;
  std::array<double, kMaxStyluses> max_force_{};  ///< of each stylus [N]
  std::vector<std::unique_ptr<SoftObject>> objects_;
  std::unique_ptr<WorldContacts> world_;  ///< null: objects touch neither each other nor scenery
  std::unique_ptr<Sleep> sleep_;          ///< null: objects never sleep
  std::array<std::unique_ptr<ToolLead>, kMaxStyluses> tools_;  ///< of each stylus; null: none
  std::array<int, kMaxStyluses> local_model_object_;           ///< object, -1: none
  std::array<StylusCommand, kMaxStyluses> commands_;  ///< of a step that begins with a reset
  std::array<StylusCommand, kMaxStyluses> contacts_;  ///< what own_contacts() returns, if changed
  LateForces late_;                                   ///< entered since the last step
};

}  // namespace irdm
