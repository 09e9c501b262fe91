#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

/// Where things are in a trace file (docs/files.md).
namespace irdm::trace {

/// Of the file and of the step that its forces were found with: 1 was of first order in time.
inline constexpr std::int64_t kVersion = 2;

/// How many steps are whole: a killed server may leave sets that are longer.
inline constexpr const char* kCommitted = "/committed";

inline std::string stylus_path(std::size_t stylus) {
  return "/stylus/" + std::to_string(stylus);
}

inline std::string settings_path(std::size_t object) {
  return "/settings/object/" + std::to_string(object);
}

/// One object's sets are those of the step; several have a group each.
inline std::string object_path(bool several, const std::string& name) {
  return several ? "/object/" + name : "/step";
}

/// Beside the body's sets of one object, within the group of one of several.
inline std::string floor_path(const std::string& object) {
  return object == "/step" ? "/floor" : object + "/floor";
}

}  // namespace irdm::trace
