#pragma once

#include <sys/types.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tests/support/temporary_folder.hpp"

namespace irdm::test {

/// How to start a program.
struct ChildOptions {
  std::filesystem::path folder = {};          ///< to run in; empty: this process's
  std::vector<std::string> environment = {};  ///< NAME=VALUE, beside this process's environment
};

/// A program that a test runs beside itself; what it prints is kept in files of its own. Every wait
/// has a deadline, and a program that is still there at the end of the test is killed.
class ChildProcess {
 public:
  /// Generous: it only says when a test that hangs gives up.
  static constexpr int kDeadlineMs = 400'000;

  /// Starts `command`, its first word being the program's path. Throws when it cannot.
  explicit ChildProcess(const std::vector<std::string>& command, const ChildOptions& options = {});
  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess& operator=(ChildProcess&&) = delete;
  ~ChildProcess();

  /// The first whole line of its output (errors: of stderr) that contains `text`. Throws, with all
  /// that it printed, when it ends or the deadline passes without one.
  std::string line_with(const std::string& text, bool errors = false);
  void signal(int number);
  /// Its exit status; less than zero: the signal that ended it, negated. A program that is still
  /// there at the deadline is killed, and this throws.
  int wait();
  bool running();
  /// Of the process while it runs; less than 0: none.
  pid_t pid() const noexcept { return pid_; }

  std::string out() const;
  std::string err() const;

 private:
  void end(int number) noexcept;
  /// Asks for its status without waiting.
  bool ended();
  std::string told() const;

  std::string name_;
  std::unique_ptr<TemporaryFolder> output_;
  pid_t pid_ = -1;
  std::optional<int> status_;
};

/// Starts a program, waits for its end and returns it, with status and output.
struct FinishedProgram {
  int status = 0;
  std::string out = {};
  std::string err = {};
};
FinishedProgram run_to_end(const std::vector<std::string>& command,
                           const ChildOptions& options = {});

/// A file's whole content; empty when it cannot be read.
std::string file_content(const std::filesystem::path& path);

}  // namespace irdm::test
