#pragma once

#include "device_bridge/safety/safety_filter.hpp"
#include "tests/bridge/milliseconds.hpp"

namespace irdm::test {

inline const Vector3 kOneUp(0, 1, 0);

/// A safety filter on a virtual clock of 1 ms a tick, armed, with a device at rest.
struct FilterRig {
  explicit FilterRig(Guards guards = {}, const FilterLimits& limits = {}) : filter(limits, guards) {
    filter.arm();
  }

  /// One tick later.
  const Vector3& tick() {
    now_ns += kMs;
    const Wrench wrench = filter.step(
        now_ns, {.tip = tip, .orientation = orientation, .saturated = saturated, .off = off},
        demand);
    shown = wrench.force;
    torque = wrench.torque;
    return shown;
  }
  /// So many ticks, each with a demand of its own moment.
  const Vector3& ticks(int count, const Vector3& force) {
    for (int i = 0; i < count; ++i) {
      demand_now(force);
      tick();
    }
    return shown;
  }
  /// The demand is of the coming tick.
  void demand_now(const Vector3& force) {
    demand.linked = true;
    demand.any = true;
    demand.sample_time_ns = now_ns + kMs;
    demand.force = force;
  }
  /// Without a step of force: it rises from nothing.
  void engage(const Vector3& force) {
    ticks(2, Vector3::Zero());
    ticks(20, force);
  }

  SafetyFilter filter;
  std::int64_t now_ns = 5'000 * kMs;
  Vector3 tip = Vector3::Zero();
  Quaternion orientation = Quaternion::Identity();
  bool saturated = false;  ///< what was shown since the last tick
  bool off = false;        ///< the motors
  ForceDemand demand{.contact = ContactState::kTouching, .normal = Vector3::UnitY()};
  Vector3 shown = Vector3::Zero();   ///< force
  Vector3 torque = Vector3::Zero();  ///< shown with it
};

}  // namespace irdm::test
