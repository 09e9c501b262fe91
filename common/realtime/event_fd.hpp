#pragma once

namespace irdm {

/// Wakes a thread that waits on a file descriptor (an event loop, say). Signalling never blocks and
/// takes no lock of ours; several signals before the wait count as one.
class EventFd {
 public:
  /// Throws Error when the system has no descriptor left.
  EventFd();
  EventFd(const EventFd&) = delete;
  EventFd& operator=(const EventFd&) = delete;
  ~EventFd();

  void signal() noexcept;
  /// Waits for a signal and consumes it; false after `timeout_ms` without one.
  bool wait(int timeout_ms) noexcept;
  /// Consumes a signal that has come; true when there was one.
  bool consume() noexcept;
  /// For an event loop: becomes readable when signalled. Owned by this object.
  int descriptor() const noexcept { return descriptor_; }

 private:
  int descriptor_;
};

}  // namespace irdm
