#pragma once

#include <string>

#include "common/config/toml_reader.hpp"
#include "common/contact/contact_problem.hpp"
#include "common/geometry.hpp"

/// Keys that several tables of a scene have. All throw Error with file and line.
namespace irdm {

/// Three numbers; absent: 0.
Vector3 read_vector(TomlTable& table, const std::string& key, const Range& range);

/// `orientation`, w x y z of any length, normalised; absent: none.
Quaternion read_orientation(TomlTable& table);

/// `normal`, up, of any length, normalised; absent: +y.
Vector3 read_normal(TomlTable& table);

/// `{ static, kinetic }`, the whole table. The default of kinetic is at most static.
Friction read_friction(TomlTable table, const Friction& fallback);

/// `name`, which becomes that of a group in the trace file.
std::string read_name(TomlTable& table, const std::string& fallback);

}  // namespace irdm
