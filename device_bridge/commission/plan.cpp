#include "device_bridge/commission/plan.hpp"

#include "device_bridge/commission/force_steps.hpp"
#include "device_bridge/commission/reading_steps.hpp"
#include "device_bridge/commission/wall_step.hpp"

namespace irdm::commission {
namespace {

constexpr int kAxes = 3;

void add_buttons(std::vector<std::unique_ptr<Step>>& plan, const ButtonMap& buttons) {
  const auto add = [&](const char* function, int bit) {
    if (bit != ButtonMap::kNone) plan.push_back(std::make_unique<ButtonStep>(function, bit));
  };
  add("grab", buttons.grab);
  add("clutch", buttons.clutch);
  add("reset", buttons.reset);
}

}  // namespace

std::vector<std::unique_ptr<Step>> make_plan(const PlanSettings& settings) {
  using Event = StopStep::Event;
  const int clutch = settings.buttons.clutch;
  std::vector<std::unique_ptr<Step>> plan;
  for (int axis = 0; axis < kAxes; ++axis) plan.push_back(std::make_unique<AxisStep>(axis));
  add_buttons(plan, settings.buttons);
  plan.push_back(std::make_unique<RestStep>());
  plan.push_back(std::make_unique<RateStep>(settings.rate));
  for (int axis = 0; axis < kAxes; ++axis) plan.push_back(std::make_unique<ForceSignStep>(axis));
  plan.push_back(std::make_unique<RampStep>(settings.max_force));
  plan.push_back(std::make_unique<StopStep>(Event::kButton, clutch));
  plan.push_back(std::make_unique<StopStep>(Event::kLink, clutch));
  plan.push_back(std::make_unique<WallStep>());
  if (!settings.simulated) plan.push_back(std::make_unique<StopStep>(Event::kCable, clutch));
  return plan;
}

}  // namespace irdm::commission
