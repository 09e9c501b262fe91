#include "common/config/input_file.hpp"

#include <string>

#include "common/error.hpp"

namespace irdm {

void require_file(const std::filesystem::path& path) {
  std::error_code ignored;
  if (std::filesystem::is_regular_file(path, ignored)) return;
  if (std::filesystem::is_directory(path, ignored)) {
    throw Error(path.string(), "is a folder", "give the path of a file");
  }
  if (std::filesystem::exists(path, ignored)) {
    throw Error(path.string(), "is not a regular file", "give the path of one");
  }
  throw Error(path.string(), "no such file", "check the path");
}

void require_file(const std::filesystem::path& path, std::uintmax_t most) {
  require_file(path);
  std::error_code ignored;
  const std::uintmax_t size = std::filesystem::file_size(path, ignored);
  if (ignored || size <= most) return;
  throw Error(path.string(), "has " + std::to_string(size) + " bytes",
              "give a text file of at most " + std::to_string(most) + " bytes");
}

}  // namespace irdm
