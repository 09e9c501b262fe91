#include "replay/rerun/delayed_forces.hpp"

#include <algorithm>
#include <memory>

namespace irdm::replay {

std::vector<DelayedForces> delayed_forces(const Recording& recording) {
  std::vector<DelayedForces> told;
  std::size_t begin = 0;  // of what has happened since the last reset
  const auto record = std::make_unique<StepRecord>();
  const auto own = std::make_unique<StepRecord>();
  for (std::size_t k = 0; k < recording.steps(); ++k) {
    recording.step(k, *record);
    if (record->reset) begin = k;
    for (const LateForce& late : record->late.view()) {
      const auto ago = static_cast<std::size_t>(late.age) + 1;
      if (k < begin + ago) continue;
      recording.step(k - ago, *own);
      const ObjectRecord& object = own->object[static_cast<std::size_t>(late.object)];
      told.push_back({k - ago, late, object.halfway});
    }
  }
  std::stable_sort(told.begin(), told.end(),
                   [](const DelayedForces& a, const DelayedForces& b) { return a.step < b.step; });
  return told;
}

void add_delayed_forces(const std::vector<DelayedForces>& told, std::size_t step, bool held_anew,
                        StepRecord& record) {
  auto one = std::lower_bound(told.begin(), told.end(), step,
                              [](const DelayedForces& a, std::size_t k) { return a.step < k; });
  for (; one != told.end() && one->step == step; ++one) {
    const auto s = static_cast<std::size_t>(one->late.stylus);
    const auto i = static_cast<std::size_t>(one->late.object);
    StylusRecord& stylus = record.stylus[s];
    const bool held = record.object[i].contact[s].state == ContactState::kHeld && stylus.present &&
                      (stylus.buttons & kGrabButton) != 0;
    if (held_anew && held) continue;
    stylus.force -= one->orientation * one->late.force;
  }
}

}  // namespace irdm::replay
