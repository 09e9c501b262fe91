#include "replay/output/part_file.hpp"

#include "common/error.hpp"
#include "common/process/part_name.hpp"

namespace irdm::replay {

PartFile::PartFile(std::filesystem::path path)
    : path_(std::move(path)), part_(fresh_part_name(path_)) {
  if (std::filesystem::exists(path_)) {
    throw Error(path_.string(), "exists already", "give another name or remove it");
  }
  const std::filesystem::path folder = std::filesystem::absolute(path_).parent_path();
  if (!std::filesystem::is_directory(folder)) {
    throw Error(folder.string(), "no such folder", "make it first");
  }
}

PartFile::~PartFile() {
  std::error_code ignored;
  std::filesystem::remove(part_, ignored);
}

void PartFile::finish() {
  std::error_code error;
  std::filesystem::rename(part_, path_, error);
  if (error) throw Error(path_.string(), "cannot be written: " + error.message(), "check the disk");
}

}  // namespace irdm::replay
