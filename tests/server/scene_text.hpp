#pragma once

#include <string>

#include "common/error.hpp"
#include "scene/scene.hpp"

namespace irdm::test {

/// An object of a scene, which needs one.
inline const std::string kObject = "[[object]]\nmodel = \"cube.h5\"\n";

inline SceneConfig scene(const std::string& text) {
  return read_scene(TomlTable::parse_text(text, "s.toml"));
}

/// The message of the error that a scene of this text must give.
inline std::string rejection(const std::string& text) {
  try {
    scene(text);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace irdm::test
