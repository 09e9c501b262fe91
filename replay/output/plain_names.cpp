#include "replay/output/plain_names.hpp"

#include <algorithm>

namespace irdm::replay {
namespace {

bool is_plain(char letter) {
  return (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') ||
         (letter >= '0' && letter <= '9') || letter == '-';
}

}  // namespace

std::vector<std::string> plain_names(const TracedScene& scene) {
  std::vector<std::string> names;
  for (std::string name : scene.names()) {
    std::replace_if(
        name.begin(), name.end(), [](char letter) { return !is_plain(letter); }, '_');
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
