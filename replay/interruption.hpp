#pragma once

namespace irdm::replay {

/// While it lives, SIGINT and SIGTERM do not end the process but are remembered, so that a long
/// computation can stop in order and leave no half-written file. A handler and not a waiting
/// thread: the threads of the BLAS start before main and may be the ones that a signal is delivered
/// to. One at a time.
class Interruption {
 public:
  Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;
  ~Interruption();

  /// Whether one has come.
  bool came() const noexcept;
};

}  // namespace irdm::replay
