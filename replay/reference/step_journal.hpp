#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace irdm::replay {

/// What a long computation has found so far, step by step, in a file beside its output: the same
/// call takes it from there when it was interrupted, by SIGKILL too, and goes on. Plain bytes, only
/// ever appended to:
///
///     irdm-steps 1\nLENGTH\n(key) (CRC32C of all so far)
///     then for each: COUNT (8 bytes), COUNT numbers (8 bytes each), CRC32C of both
///
/// A record whose checksum is wrong, and all after it, do not count. One thread.
class StepJournal {
 public:
  /// @param key all that the numbers depend on: a file with another one is given up
  /// Throws Error when the file cannot be written.
  StepJournal(std::filesystem::path path, const std::string& key);

  /// The next record of an earlier call; false: there is none any more.
  bool take(std::vector<double>& numbers);
  /// The next one, once take() has said so. Throws Error when the disk takes no more.
  void keep(const std::vector<double>& numbers);
  /// Records taken.
  std::size_t taken() const noexcept { return taken_; }
  /// The output is complete: the file goes.
  void remove() noexcept;

 private:
  bool has_key(const std::string& head);
  void begin_to_keep();
  [[noreturn]] void fail() const;

  std::filesystem::path path_;
  std::fstream file_;
  std::streamoff size_ = 0;
  std::streamoff end_ = 0;  ///< of what counts
  bool keeps_ = false;
  std::size_t taken_ = 0;
};

}  // namespace irdm::replay
