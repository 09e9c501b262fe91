#pragma once

#include <sys/types.h>

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/process/signal_cleanup.hpp"

namespace irdm {

/// What a program is started with besides its words; it has no input.
struct ChildSettings {
  std::filesystem::path folder = {};        ///< to run in; empty: this process's
  std::filesystem::path log = "/dev/null";  ///< for its output and errors
  bool own_group = false;                   ///< a Ctrl-C at the terminal does not reach it
  std::map<int, int> descriptors = {};      ///< by the number that it has them under: ours
};

/// A program that runs beside this one. It ends with this object, the thread that made it or the
/// process at the latest, however these end.
class ChildProgram {
 public:
  /// @param command first the program, looked up in PATH; no shell sees it
  /// Throws Error when it cannot be started.
  explicit ChildProgram(const std::vector<std::string>& command,
                        const ChildSettings& settings = {});
  ChildProgram(const ChildProgram&) = delete;
  ChildProgram& operator=(const ChildProgram&) = delete;
  ~ChildProgram();  ///< gives it three seconds to end by itself

  /// Waits; false: it still runs.
  bool ends_within(double seconds) noexcept;
  void kill() noexcept;
  /// Of a program that has ended; -1: it was ended by a signal.
  int status() const noexcept { return status_; }

 private:
  void collect() noexcept;

  bool own_group_;
  pid_t pid_ = 0;  // 0: it has ended
  std::optional<SignalCleanup> cleanup_;
  int status_ = -1;
};

/// Whether PATH has a program of that name.
bool program_exists(const std::string& name);

/// How a child process ended.
enum class ChildEnd { kSuccess, kFailure, kNotFound, kTimeout };

/// Runs a program and waits for its end; after `time_limit_s` it is killed.
/// @param arguments without the program's name
ChildEnd run_child(const std::string& program, const std::vector<std::string>& arguments,
                   const std::filesystem::path& folder, const std::filesystem::path& log_file,
                   double time_limit_s);

}  // namespace irdm
