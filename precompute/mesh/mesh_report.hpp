#pragma once

#include <optional>
#include <string>

#include "precompute/mesh/tet_mesh.hpp"

namespace irdm::precompute {

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

/// @param mesh that passed check_mesh
MeshReport report_mesh(const TetMesh& mesh);

/// "0.12 x 0.1 x 0.08 m".
std::string format_extent(const Vector3& extent);

/// What to say about a body that is larger than 10 m or smaller than 0.1 mm: most likely its file
/// has another unit than the configuration says. Nothing for sizes between.
std::optional<std::string> unit_hint(const Vector3& extent);

}  // namespace irdm::precompute
