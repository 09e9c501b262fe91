#pragma once

#include <filesystem>
#include <optional>

#include "common/config/toml_reader.hpp"
#include "common/model/model.hpp"

namespace irdm::precompute {

/// [display]: the surface that viewers draw, `file = "name"` or `subdivision`.
struct DisplayConfig {
  /// .obj, with its normals and texture coordinates, .stl or .ply, at its place about the mesh.
  std::optional<std::filesystem::path> file;
  double unit = 1.0;  ///< length of the file's unit [m]: `unit = "m" | "cm" | "mm"`
  /// A PNG or JPEG file, for texture coordinates of the .obj.
  std::optional<std::filesystem::path> texture;
  /// Into how many parts each edge of the surface's triangles is cut, 2..16; the surface between
  /// them is curved.
  int subdivision = 0;
  /// Edges with a larger angle between their triangles stay sharp [rad], where a file says no
  /// normals: `crease_angle`, 0..180 degrees.
  double crease_angle = 0.0;
};

/// Throws Error with file and line.
/// @param unit length of the unit of [mesh] [m], which is the default
DisplayConfig read_display_config(TomlTable table, double unit);

/// The display mesh, each vertex bound to the nearest point of the model's surface, of triangles
/// that face as it does where there are some.
/// Throws Error when a file is missing, damaged or too large, or does not lie about the surface.
/// @param mesh with nodes about the centre of mass
DisplayMesh make_display_mesh(const DisplayConfig& config, const ModelMesh& mesh);

/// The largest distance of a vertex at rest from where it is bound [m].
double largest_distance(const DisplayMesh& display, const ModelMesh& mesh);

}  // namespace irdm::precompute
