#pragma once

#include <filesystem>

#include "precompute/mesh/surface_mesh.hpp"

namespace irdm::precompute {

/// A surface of triangles with what its corners look like. t triangles; corner i of triangle t has
/// row 3 t + i.
struct ShadedSurface {
  using TextureCoordinates = Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>;

  SurfaceMesh mesh;
  Points normals;              ///< (3t, 3) unit; no rows: none are known
  TextureCoordinates texture;  ///< (3t, 2); no rows: none are known
};

/// Reads an .obj with normals and texture coordinates, where every corner has them; its shapes and
/// materials are passed over. Throws Error with file and line for truncated or damaged files.
ShadedSurface read_shaded_obj(const std::filesystem::path& path);

/// Reads an .obj, .stl or .ply. Where nothing is known of the corners every place is there once.
/// Throws Error.
ShadedSurface read_shaded_surface(const std::filesystem::path& path);

}  // namespace irdm::precompute
