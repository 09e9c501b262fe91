#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "device_bridge/commission/guided_stylus.hpp"
#include "device_bridge/commission/step_runner.hpp"
#include "device_bridge/servo_loop.hpp"
#include "tests/bridge/milliseconds.hpp"
#include "tests/support/catch.hpp"

namespace irdm::test {

/// A virtual device, held by somebody who does what is asked, and what can be wrong with it.
class FaultyStylus : public commission::GuidedStylus {
 public:
  explicit FaultyStylus(const SensorParameters& sensor = {})
      : GuidedStylus(std::nullopt, sensor, {}) {}

  StylusPose read(double time) noexcept override {
    StylusPose pose = GuidedStylus::read(time);
    pose.tip = reading_axes * (pose.tip + drift(time));
    pose.buttons <<= button_shift;
    repeats = repeats_every > 0 && ++reads % repeats_every != 0;
    if (unplugged) pose.tip.setConstant(std::numeric_limits<double>::quiet_NaN());
    return pose;
  }
  void write(const Wrench& shown) noexcept override {
    GuidedStylus::write({force_axes * shown.force});
  }
  DeviceState state() const noexcept override {
    DeviceState state = GuidedStylus::state();
    state.ready = ready;
    state.repeated = repeats;
    state.failed = state.lost = unplugged;
    return state;
  }

  Matrix3 reading_axes = Matrix3::Identity();  ///< tip as it is to tip as it is read
  Matrix3 force_axes = Matrix3::Identity();    ///< force as it is asked for to force that acts
  std::function<Vector3(double)> drift = [](double) { return Vector3(Vector3::Zero()); };  ///< [m]
  int button_shift = 0;
  int repeats_every = 0;  ///< of so many readings one is new; 0: all
  bool ready = true;
  bool unplugged = false;

 private:
  int reads = 0;
  bool repeats = false;
};

/// Steps in the servo loop of such a device, on a virtual clock.
class StepRig {
 public:
  explicit StepRig(FaultyStylus& stylus, const FilterLimits& limits = {})
      : device(stylus), loop(stylus, limits, {}) {}

  /// To its end, or until `ticks` are over, and then what came of it.
  commission::Judgement run(commission::Step& step, int ticks = 200'000) {
    device.ask(step.request().order);
    runner.begin(step);
    for (int i = 0; i < ticks && !runner.ended().consume(); ++i) tick();
    return step.judge(measured);
  }
  void tick() {
    now_ns += period_ns;
    loop.read(1e-9 * static_cast<double>(now_ns));
    link.styluses[0].input.receive();
    loop.apply(now_ns, link.styluses[0].input.front());
    TickRow row;
    row.time_ns = now_ns;
    runner.put(row);
  }

  FaultyStylus& device;
  ServoLoop loop;
  ServoLink link{1};
  commission::StepRunner runner{loop, link};
  commission::Measured measured;
  std::int64_t now_ns = 0;
  std::int64_t period_ns = kMs;
};

/// Two axes exchanged.
inline Matrix3 swapped(int a, int b) {
  Matrix3 axes = Matrix3::Identity();
  axes.col(a).swap(axes.col(b));
  return axes;
}

/// One axis the other way round.
inline Matrix3 reversed(int axis) {
  Matrix3 axes = Matrix3::Identity();
  axes(axis, axis) = -1.0;
  return axes;
}

}  // namespace irdm::test
