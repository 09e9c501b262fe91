#include "replay/output/new_folder.hpp"

#include "common/error.hpp"

namespace irdm::replay {

void make_new_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder)) {
    throw Error(folder.string(), "cannot be made a folder", "give another place");
  }
  if (!std::filesystem::is_empty(folder)) {
    throw Error(folder.string(), "is not empty", "give a new folder, or empty it");
  }
}

}  // namespace irdm::replay
