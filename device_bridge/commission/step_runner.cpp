#include "device_bridge/commission/step_runner.hpp"

#include <utility>

#include "common/realtime/clock.hpp"

namespace irdm::commission {

void StepRunner::begin(Step& step) noexcept {
  stop_ = false;
  last_ns_ = 0;
  step_.store(&step, std::memory_order_release);
}

Seen StepRunner::see(std::int64_t now_ns) noexcept {
  const std::int64_t before_ns = std::exchange(last_ns_, now_ns);
  return {
      .elapsed = before_ns == 0 ? 0.0 : kNanosecond * static_cast<double>(now_ns - before_ns),
      .tip = loop_.reading(),
      .buttons = loop_.device_buttons(),
      .device = loop_.device_state(),
      .shown = loop_.shown(),
      .gain = loop_.filter().gain(),
      .fault = loop_.filter().state() == FilterState::kFault,
  };
}

Demand StepRunner::run_step(std::int64_t now_ns) noexcept {
  const Demand none{.linked = false};
  Step* const step = step_.load(std::memory_order_acquire);
  if (step == nullptr) return none;
  const Demand demand = stop_ ? none : step->tick(see(now_ns));
  if (!stop_ && !step->over()) return demand;
  step_.store(nullptr, std::memory_order_release);
  ended_.signal();
  return none;
}

void StepRunner::put(const TickRow& row) noexcept {
  const Demand demand = run_step(row.time_ns);
  const ContactState contact = demand.contact ? ContactState::kHeld : ContactState::kFree;
  link_.styluses[0].input.put(
      {.linked = demand.linked,
       .any_force = true,
       .force = {.sample_time_ns = row.time_ns, .contact = contact, .force = demand.force},
       .ageless = !demand.contact});
}

}  // namespace irdm::commission
