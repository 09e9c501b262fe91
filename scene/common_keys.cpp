#include "scene/common_keys.hpp"

#include <algorithm>

#include "common/config/range.hpp"

namespace irdm {

Vector3 read_vector(TomlTable& table, const std::string& key, const Range& range) {
  return Vector3(table.numbers(key, 3, range, {0.0, 0.0, 0.0}).data());
}

Quaternion read_orientation(TomlTable& table) {
  const auto wxyz = table.numbers("orientation", 4, lab::kComponent, {1.0, 0.0, 0.0, 0.0});
  const Quaternion orientation(wxyz[0], wxyz[1], wxyz[2], wxyz[3]);
  constexpr double kSmallest = 1e-6;
  if (orientation.norm() < kSmallest) {
    table.fail("orientation", "has no length",
               "give a quaternion w, x, y, z, for instance [1, 0, 0, 0]");
  }
  return orientation.normalized();
}

Vector3 read_normal(TomlTable& table) {
  const Vector3 normal(table.numbers("normal", 3, lab::kComponent, {0.0, 1.0, 0.0}).data());
  if (normal.norm() < 1e-6) {
    table.fail("normal", "has no length", "give the direction that is up, for instance [0, 1, 0]");
  }
  return normal.normalized();
}

Friction read_friction(TomlTable table, const Friction& fallback) {
  Friction friction;
  friction.static_ = table.number("static", lab::kFriction, fallback.static_);
  friction.kinetic =
      table.number("kinetic", lab::kFriction, std::min(fallback.kinetic, friction.static_));
  if (friction.kinetic > friction.static_) {
    table.fail("kinetic", "is larger than static", "lower it or raise static");
  }
  table.finish();
  return friction;
}

std::string read_name(TomlTable& table, const std::string& fallback) {
  const std::string name = table.text("name", fallback);
  const bool printable = std::none_of(name.begin(), name.end(), [](unsigned char letter) {
    return letter < 0x20 || letter == 0x7F || letter == '/';
  });
  if (name.size() > lab::kLongestName) {
    table.fail("name", "has " + std::to_string(name.size()) + " bytes",
               "give at most " + std::to_string(lab::kLongestName));
  }
  if (name.empty() || name == "." || !printable) {
    table.fail("name", "cannot name a group of the trace file",
               "use one or more letters, without '/' and control characters, and not \".\" alone");
  }
  return name;
}

}  // namespace irdm
