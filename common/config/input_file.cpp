#include "common/config/input_file.hpp"

#include "common/error.hpp"

namespace irdm {

void require_file(const std::filesystem::path& path) {
  std::error_code ignored;
  if (std::filesystem::is_regular_file(path, ignored)) return;
  if (std::filesystem::is_directory(path, ignored)) {
    throw Error(path.string(), "is a folder", "give the path of a file");
  }
  throw Error(path.string(), "no such file", "check the path");
}

}  // namespace irdm
