#pragma once

#include <functional>

namespace irdm {

/// Makes the ticks of the servo loop where the driver of a device makes them itself, on a thread of
/// its own, and takes forces only inside them.
class TickSource {
 public:
  TickSource() = default;
  TickSource(const TickSource&) = delete;
  TickSource& operator=(const TickSource&) = delete;
  virtual ~TickSource() = default;

  /// From now on calls `tick` about `rate` times a second, until it returns false or stop(). Throws
  /// Error when the driver cannot.
  /// @param rate [Hz]
  /// @param tick real-time safe, does not throw; never called twice at a time
  virtual void start(double rate, std::function<bool()> tick) = 0;
  /// When it returns, no tick is under way and none comes any more.
  virtual void stop() noexcept = 0;
};

}  // namespace irdm
