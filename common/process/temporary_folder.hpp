#pragma once

#include <filesystem>
#include <string>

namespace irdm {

/// A new empty folder that is removed with all its content. Throws Error when none can be made.
class TemporaryFolder {
 public:
  explicit TemporaryFolder(const std::string& prefix = "irdm");
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder();

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace irdm
