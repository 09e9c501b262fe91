#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>

namespace irdm {

/// What is done when a signal ends the process.
struct CleanupAction {
  pid_t kill = 0;                     ///< a child process; less than 0: its group; 0: none
  std::filesystem::path remove = {};  ///< a file, or a folder with all that is in it; empty: none
  std::string say = {};               ///< on stderr, with its line end
};

/// While it lives, SIGINT, SIGTERM, SIGHUP and SIGPIPE do one last thing before they end the
/// process as they always do; a signal that is ignored (nohup) or has a handler of the program's
/// own stays as it is, and so does a child of fork(). A handler and not a waiting thread: the
/// threads of the BLAS start before main and may be the ones that a signal is delivered to. Up to
/// 16 at a time; further ones do nothing. Any thread.
class SignalCleanup {
 public:
  explicit SignalCleanup(const CleanupAction& action);
  SignalCleanup(const SignalCleanup&) = delete;
  SignalCleanup& operator=(const SignalCleanup&) = delete;
  ~SignalCleanup();

 private:
  int place_ = -1;  ///< in the table that the handler reads; less than 0: there was no room
};

}  // namespace irdm
