#pragma once

#include <filesystem>

#include "precompute/mesh/tet_mesh.hpp"

namespace irdm::precompute {

/// Reads the linear tetrahedra of a VTK XML file (.vtu, one piece): arrays in the file or appended,
/// as text, base64 or raw bytes, plain or compressed by zlib, of either byte order, as ParaView,
/// VTK and meshio write them; coordinates as they are there. Vertices, lines, surface cells and all
/// data on points and cells are passed over. Throws Error for other compressors, several pieces,
/// other volume cells, truncated or damaged files.
TetMesh read_vtu(const std::filesystem::path& path);

}  // namespace irdm::precompute
