#pragma once

#include <cstddef>
#include <string>

/// Where things are in a run file (docs/files.md).
namespace irdm::replay::run {

inline constexpr const char* kFormat = "irdm-run";
inline constexpr int kVersion = 1;

inline std::string object_path(std::size_t object) {
  return "/object/" + std::to_string(object);
}

inline std::string stylus_path(std::size_t stylus) {
  return "/stylus/" + std::to_string(stylus);
}

}  // namespace irdm::replay::run
