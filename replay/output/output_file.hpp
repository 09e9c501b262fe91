#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "replay/traced_scene.hpp"

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

/// Makes a folder where there is none, and throws Error when there is one with something in it.
void make_new_folder(const std::filesystem::path& folder);

/// A name for columns and files: letters, digits and - alone, the rest is _.
std::string plain_name(std::string name);

/// Such names of the objects; no two are the same.
std::vector<std::string> plain_names(const TracedScene& scene);

}  // namespace irdm::replay
