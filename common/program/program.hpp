#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

namespace irdm {

/// SIGINT and SIGTERM as something to wait for. Make one in main before any thread starts: the
/// signals are blocked from then on in every thread, and SIGPIPE is ignored.
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

/// Threads of OpenMP that have nothing to do are to sleep: by default they turn round and round for
/// about a millisecond after each loop, beside the real-time threads. The runtime reads how it is
/// to wait when the program is loaded, so this starts the program again (same process, same
/// arguments) with OMP_WAIT_POLICY=passive. Returns at once when the environment says how to wait.
/// First thing in main().
void wait_passively_in_openmp(char** argv);

// The frame that the mains share: exit 0 on success, 1 on a failure said in one line on stderr,
// 2 on wrong usage.

/// Of an option: a finite number above zero. (CLI11's own check lets "nan" through.)
CLI::Validator positive_number();

/// Adds --version, parses the command line and runs `body`; returns the exit status. An exception
/// out of `body` becomes one line on stderr, `NAME: error: WHAT`, and status 1. Beside wrong usage
/// it names the option or command that was probably meant.
int run_program(CLI::App& app, int argc, char** argv, const std::function<int()>& body);

}  // namespace irdm
