#pragma once

#include <cstdint>

#include "device_bridge/commission/obedient_hand.hpp"
#include "device_bridge/commission/step_runner.hpp"
#include "device_bridge/servo_loop.hpp"
#include "tests/bridge/milliseconds.hpp"

namespace irdm::test {

/// The servo loop of a device with a step runner, on a virtual clock, and the hand that holds it.
class HeldDevice {
 public:
  explicit HeldDevice(HapticDevice& device)
      : loop_(device, {.max_force = 3.3}), runner_(loop_, link_) {}

  void tick() {
    now_ns_ += kMs;
    loop_.read(0.0);
    link_.styluses[0].input.receive();
    loop_.apply(now_ns_, link_.styluses[0].input.front());
    TickRow row;
    row.time_ns = now_ns_;
    runner_.put(row);
  }
  commission::StepRunner& runner() { return runner_; }
  const Vector3& shown() const { return loop_.shown(); }  ///< force of the tick [N], D

  commission::ObedientHand hand;
  VirtualSensor sensor{{.resolution = 2e-5, .noise = 1e-5}};

 private:
  ServoLoop loop_;
  ServoLink link_{1};
  commission::StepRunner runner_;
  std::int64_t now_ns_ = 0;
};

}  // namespace irdm::test
