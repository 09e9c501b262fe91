#include "replay/rerun/input_rerun.hpp"

#include "common/error.hpp"

namespace irdm::replay {
namespace {

StylusCommand command_of(const StylusRecord& stylus, bool solve_bridged) {
  StylusCommand command{stylus.present, stylus.buttons, stylus.tip, std::nullopt};
  if (!solve_bridged) command.bridged = stylus.bridged;
  return command;
}

}  // namespace

InputRerun::InputRerun(const SimulationConfig& config, bool solve_bridged)
    : config_(config), solve_bridged_(solve_bridged), simulation_(config) {}

void InputRerun::insert_delayed_force(const StepRecord& recorded) {
  for (const LateForce& late : recorded.late.view()) {
    if (simulation_.insert_delayed_force(late)) continue;
    throw Error("/late", "has a force for a step that is not in the trace", "record it again");
  }
}

// In the order in which the force thread does it.
void InputRerun::step(const StepRecord& recorded, StepRecord& again) {
  if (!solve_bridged_) insert_delayed_force(recorded);
  if (!(recorded.settings == simulation_.settings())) {
    check_settings(config_, recorded.settings);
    simulation_.set(recorded.settings);
  }
  std::array<StylusCommand, kMaxStyluses> commands;
  const auto styluses = static_cast<std::size_t>(recorded.stylus_count);
  for (std::size_t s = 0; s < styluses; ++s) {
    commands[s] = command_of(recorded.stylus[s], solve_bridged_);
  }
  simulation_.step({commands.data(), styluses}, again, recorded.reset);
}

}  // namespace irdm::replay
