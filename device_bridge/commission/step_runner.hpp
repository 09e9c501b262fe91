#pragma once

#include <atomic>
#include <cstdint>

#include "common/realtime/event_fd.hpp"
#include "device_bridge/blackbox/tick_log.hpp"
#include "device_bridge/commission/step.hpp"
#include "device_bridge/servo_link.hpp"
#include "device_bridge/servo_loop.hpp"

namespace irdm::commission {

/// Runs steps inside the servo loop, in the place of a server: after each tick it answers with what
/// the step wants, for the next one. Between steps it is as if the server were lost, so that the
/// safety filter fades the force; in a step's first half second the filter lets it rise.
class StepRunner final : public TickListener {
 public:
  /// @param loop of the link's only stylus
  StepRunner(const ServoLoop& loop, ServoLink& link) : loop_(loop), link_(link) {}

  /// A step from its first tick on; no other runs. Main thread, as the next two.
  void begin(Step& step) noexcept;
  /// Ends a step that still runs; ended() comes.
  void stop() noexcept { stop_ = true; }
  /// Signalled when a step has had its last tick: it may be judged.
  EventFd& ended() noexcept { return ended_; }

  /// Servo thread.
  void put(const TickRow& row) noexcept override;

 private:
  Seen see(std::int64_t now_ns) noexcept;
  Demand run_step(std::int64_t now_ns) noexcept;

  const ServoLoop& loop_;
  ServoLink& link_;
  std::atomic<Step*> step_{nullptr};
  std::atomic<bool> stop_{false};
  std::int64_t last_ns_ = 0;  ///< of the step's tick before; 0: none
  EventFd ended_;
};

}  // namespace irdm::commission
