#pragma once

#include <filesystem>
#include <string>

namespace irdm::precompute {

/// What is done when a signal ends the process.
struct CleanupAction {
  std::filesystem::path remove = {};  ///< a file; empty: none
  std::string say = {};               ///< on stderr, with its line end
};

/// While it lives, SIGINT, SIGTERM, SIGHUP and SIGPIPE do one last thing before they end the
/// process as they always do; a signal that is ignored (nohup) stays ignored. A handler and not a
/// waiting thread: the threads of the BLAS start before main and may be the ones that a signal is
/// delivered to. One at a time.
class SignalCleanup {
 public:
  explicit SignalCleanup(const CleanupAction& action);
  SignalCleanup(const SignalCleanup&) = delete;
  SignalCleanup& operator=(const SignalCleanup&) = delete;
  ~SignalCleanup();
};

}  // namespace irdm::precompute
