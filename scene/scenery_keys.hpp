#pragma once

#include <filesystem>

#include "common/config/toml_reader.hpp"
#include "simulation/collision/scenery.hpp"

namespace irdm {

/// One [[scenery]] table. Throws Error with file and line.
/// @param model the file of a mesh's surface; empty: it is no mesh
SceneryConfig read_scenery(TomlTable table, std::filesystem::path& model);

/// The surface of a rigid body's model file. Throws Error.
MeshShape read_mesh_shape(const std::filesystem::path& model);

}  // namespace irdm
