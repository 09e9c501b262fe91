#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <variant>

#include "common/config/toml_reader.hpp"
#include "common/geometry.hpp"

namespace irdm::precompute {

/// A box to be meshed: one corner at the origin, edges along the axes.
struct BoxConfig {
  Vector3 size = Vector3::Zero();        ///< edge lengths [m], > 0
  std::array<int, 3> cells = {0, 0, 0};  ///< grid cells along each edge, 1..100
};

/// A sphere to be meshed, about the origin.
struct SphereConfig {
  double radius = 0.0;  ///< [m], > 0
  int cells = 0;        ///< along a quarter of the circumference, 2..100
};

/// A cylinder with half a sphere at each end to be meshed, about the origin, along the y axis.
struct CapsuleConfig {
  double radius = 0.0;  ///< [m], > 0
  double length = 0.0;  ///< between the centres of the half spheres [m], > 0
  int cells = 0;        ///< along a quarter of the circumference, 2..100
};

/// [mesh]: one of `box = { size = [..], cells = [..] }`, `sphere = { radius = .., cells = .. }`,
/// `capsule = { radius = .., length = .., cells = .. }` and `file = "name"`, of a format that
/// mesh_file.hpp and docs/meshes.md list.
struct MeshConfig {
  std::variant<BoxConfig, SphereConfig, CapsuleConfig, std::filesystem::path> source;
  /// Length of the mesh file's unit [m]: `unit = "m" | "cm" | "mm"`, "m" unless given. The others
  /// are in m.
  double unit = 1.0;
  /// Target edge length of the tetrahedra of a surface [m], > 0; none: its triangles are kept.
  std::optional<double> edge_length;
  /// 1: linear, 2: quadratic tetrahedra, whose mid-side nodes are made here. Cells are those of the
  /// tetrahedra: 6 cells an edge of order 2 have the surface nodes of 12 cells of order 1.
  int order = 2;
};

/// The length of the unit of a file that table key `unit` names [m]: "m" | "cm" | "mm".
/// Throws Error with file and line.
double read_unit(TomlTable& table, double fallback);

/// Throws Error with file and line.
/// @param default_order of the tetrahedra, where the table has no key `order`
MeshConfig read_mesh_config(TomlTable table, int default_order);

}  // namespace irdm::precompute
