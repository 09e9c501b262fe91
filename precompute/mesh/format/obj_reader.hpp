#pragma once

#include <filesystem>

#include "precompute/mesh/surface_mesh.hpp"

namespace irdm::precompute {

/// Reads the vertices and faces of a Wavefront OBJ file, all its objects together; polygons are cut
/// into triangles; texture, normals, groups and materials are passed over. Throws Error with file
/// and line for truncated or damaged files.
SurfaceMesh read_obj(const std::filesystem::path& path);

}  // namespace irdm::precompute
