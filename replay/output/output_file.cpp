#include "replay/output/output_file.hpp"

#include <algorithm>

#include "common/error.hpp"
#include "common/process/temporary_files.hpp"

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

namespace {

bool is_plain(char letter) {
  return (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') ||
         (letter >= '0' && letter <= '9') || letter == '-';
}

}  // namespace

std::string plain_name(std::string name) {
  std::replace_if(
      name.begin(), name.end(), [](char letter) { return !is_plain(letter); }, '_');
  return name;
}

std::vector<std::string> plain_names(const TracedScene& scene) {
  std::vector<std::string> names;
  for (std::string name : scene.names()) {
    name = plain_name(std::move(name));
    if (name.starts_with("stylus")) name = "object_" + name;  // those are the styluses' own
    const std::string wanted = name;
    for (int more = 2; std::find(names.begin(), names.end(), name) != names.end(); ++more) {
      name = wanted + "_" + std::to_string(more);
    }
    names.push_back(name);
  }
  return names;
}

}  // namespace irdm::replay
