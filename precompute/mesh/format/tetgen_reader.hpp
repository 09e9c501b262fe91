#pragma once

#include <filesystem>

#include "precompute/mesh/tet_mesh.hpp"

namespace irdm::precompute {

/// Reads a mesh that TetGen wrote: a .node and an .ele file of the same name, either of which may
/// be given; numbered from 0 or from 1; coordinates as they are there. Attributes and markers are
/// passed over. Throws Error with file and line for missing, truncated or damaged files and for
/// second-order elements.
TetMesh read_tetgen(const std::filesystem::path& path);

}  // namespace irdm::precompute
