#pragma once

#include <filesystem>
#include <fstream>
#include <string_view>

#include "common/process/temporary_files.hpp"

namespace irdm::fuzz {

/// A file with this content, in a folder of this process; the next one of the name takes its place.
inline std::filesystem::path scratch_file(const char* name, std::string_view content) {
  static const irdm::TemporaryFolder folder("irdm-fuzz");
  const std::filesystem::path path = folder.path() / name;
  std::ofstream(path, std::ios::binary)
      .write(content.data(), static_cast<std::streamsize>(content.size()));
  return path;
}

}  // namespace irdm::fuzz
