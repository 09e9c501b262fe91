#pragma once

#include <filesystem>

#include "precompute/mesh/tet_mesh.hpp"

namespace irdm::precompute {

/// Reads the linear tetrahedra of a VTK legacy file (versions 1.0 to 5.1, ASCII or binary) that
/// holds an unstructured grid; coordinates as they are there. Vertices, lines, surface cells and
/// all data on points and cells are passed over. Throws Error with file and line for other data
/// sets, other volume cells, truncated or damaged files.
TetMesh read_vtk(const std::filesystem::path& path);

}  // namespace irdm::precompute
