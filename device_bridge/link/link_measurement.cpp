#include "device_bridge/link/link_measurement.hpp"

#include <algorithm>
#include <cmath>

#include "common/contact/contact_model.hpp"
#include "common/realtime/clock.hpp"

namespace irdm {

void LinkMeasurement::tick(std::int64_t now_ns, std::int64_t late_ns,
                           const ServoInput& input) noexcept {
  ++ticks;
  wakeup.add(late_ns);
  if (!input.linked || !input.any_force) return;
  const std::int64_t age_ns = now_ns - input.force.sample_time_ns;
  age.add(age_ns);
  if (age_ns <= kHoldNs) ++young_for_hold;
  if (age_ns <= predict_limit_ns()) ++young_for_predict;
}

std::int64_t LinkMeasurement::predict_limit_ns() const noexcept {
  if (!(dt > 0.0)) return kPredictNs;
  return std::min<std::int64_t>(kPredictNs, std::llround(kNanosecondsPerSecond * kMaxHorizon * dt));
}

double LinkMeasurement::share(std::uint64_t count) const noexcept {
  return ticks > 0 ? static_cast<double>(count) / static_cast<double>(ticks) : 0.0;
}

double LinkMeasurement::loss() const noexcept {
  const std::uint64_t steps = client.forces + client.steps_missed;
  return steps > 0 ? static_cast<double>(client.steps_missed) / static_cast<double>(steps) : 0.0;
}

}  // namespace irdm
