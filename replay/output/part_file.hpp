#pragma once

#include <filesystem>

namespace irdm::replay {

/// A file under another name beside its own until it is complete. One that is not is removed.
class PartFile {
 public:
  /// Throws Error when there is a file of that name, or no folder for it.
  explicit PartFile(std::filesystem::path path);
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;
  ~PartFile();

  /// Where to write meanwhile.
  const std::filesystem::path& part() const { return part_; }
  /// It is complete. Throws Error.
  void finish();

 private:
  std::filesystem::path path_;
  std::filesystem::path part_;
};

}  // namespace irdm::replay
