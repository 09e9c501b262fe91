#pragma once

namespace irdm {

/// Waits for SIGINT, SIGTERM and, unless nohup ignores it, SIGHUP. Construct one in main before any
/// thread starts: from then on the signals are blocked in every thread, and SIGPIPE is ignored.
class StopSignal {
 public:
  StopSignal();
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;
  ~StopSignal();

  /// Waits until a signal has come (true) or one of the others is readable (false); -1: no other.
  bool wait(int other_descriptor = -1, int third_descriptor = -1);
  /// Waits at most `timeout_ms`, or until `other_descriptor` is readable; true when a signal has
  /// come.
  bool wait_for(int timeout_ms, int other_descriptor = -1);

 private:
  int descriptor_;
};

}  // namespace irdm
