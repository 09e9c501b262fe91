#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "common/process/signal_cleanup.hpp"

namespace irdm {

/// The name under which this process writes a file until it is complete: NAME.part-PID, beside it.
/// Removes what processes of this machine that were killed have left of the same file; what a
/// living one writes stays.
std::filesystem::path fresh_part_name(const std::filesystem::path& path);

/// A new empty folder that is removed with all its content, also when a signal ends the process
/// (see SignalCleanup). Throws Error when none can be made.
class TemporaryFolder {
 public:
  explicit TemporaryFolder(const std::string& prefix = "irdm");
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder();

  const std::filesystem::path& path() const { return path_; }
  /// Throws Error when no space is left there: what a program wrote there may not be whole.
  void require_space() const;

 private:
  std::filesystem::path path_;
  std::optional<SignalCleanup> cleanup_;
};

}  // namespace irdm
