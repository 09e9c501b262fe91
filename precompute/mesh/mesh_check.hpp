#pragma once

#include <optional>
#include <string>

#include "precompute/mesh/surface_mesh.hpp"
#include "precompute/mesh/tet_mesh.hpp"

namespace irdm::precompute {

/// The surface with all triangles turned the same way round. Throws Error (about `name`, with the
/// place in the surface's own coordinates) unless it can bound a body: at least four triangles;
/// finite coordinates; closed and manifold, so that two triangles meet at every edge; one piece.
/// Self-intersection is left to check_self_intersection.
SurfaceMesh checked_surface(const SurfaceMesh& surface, const std::string& name);

/// Mean ratio up to which an element is called flat; those of sound meshes are above 0.1.
inline constexpr double kFlatMeanRatio = 0.01;

/// What a person should see of a mesh before trusting it.
struct MeshReport {
  Vector3 extent = Vector3::Zero();  ///< edge lengths of the bounding box [m]
  double worst_quality = 0.0;        ///< lowest mean ratio of the elements
  double median_quality = 0.0;       ///< of the mean ratios
};

/// Mean ratio of element e: 12 (3 V)^(2/3) / sum of the squared edge lengths (Liu and Joe,
/// Relationship between tetrahedron shape measures, BIT 34, 1994). 1 for a regular tetrahedron,
/// near 0 for a flat one.
double mean_ratio(const TetMesh& mesh, int e);

/// The tetrahedron of the lowest mean ratio, for messages, where that is flat: "the tetrahedron
/// around (0.1, 0, 0.02) m, which is flat (mean ratio 1.2e-05)".
std::optional<std::string> flattest_element(const TetMesh& mesh);

/// @param mesh that passed check_mesh
MeshReport report_mesh(const TetMesh& mesh);

/// "0.12 x 0.1 x 0.08 m".
std::string format_extent(const Vector3& extent);

/// What to say about a body that is larger than 10 m or smaller than 0.1 mm: most likely its file
/// has another unit than the configuration says. Nothing for sizes between.
std::optional<std::string> unit_hint(const Vector3& extent);

/// Throws Error unless the mesh is one that can be computed with: at least one element; finite
/// coordinates; indices in range and distinct within an element; every node used; volumes positive
/// and not vanishing, also where edges are curved; one piece, joined through faces; a closed
/// surface in which two triangles meet at every edge. `name` stands for the mesh in the messages,
/// which say places in the coordinates of the mesh, as the numbers of a file are not known here.
void check_mesh(const TetMesh& mesh, const std::string& name);

}  // namespace irdm::precompute
