#include "precompute/mesh/mesh_report.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace irdm::precompute {
namespace {

constexpr double kLargestSize = 10.0;   // [m]
constexpr double kSmallestSize = 1e-4;  // [m]

}  // namespace

double mean_ratio(const TetMesh& mesh, int e) {
  double squares = 0.0;
  for (const auto& [i, j] : kTetEdges) {
    squares += (mesh.position(mesh.tets(e, i)) - mesh.position(mesh.tets(e, j))).squaredNorm();
  }
  return 12.0 * std::pow(3.0 * signed_volume(mesh, e), 2.0 / 3.0) / squares;
}

MeshReport report_mesh(const TetMesh& mesh) {
  std::vector<double> quality;
  for (int e = 0; e < mesh.tet_count(); ++e) quality.push_back(mean_ratio(mesh, e));
  std::sort(quality.begin(), quality.end());
  return {(mesh.nodes.colwise().maxCoeff() - mesh.nodes.colwise().minCoeff()).transpose(),
          quality.front(), quality[quality.size() / 2]};
}

std::string format_extent(const Vector3& extent) {
  char text[64];
  std::snprintf(text, sizeof text, "%.4g x %.4g x %.4g m", extent.x(), extent.y(), extent.z());
  return text;
}

std::optional<std::string> unit_hint(const Vector3& extent) {
  const double size = extent.maxCoeff();
  if (size <= kLargestSize && size >= kSmallestSize) return std::nullopt;
  const std::string found = "the body is " + format_extent(extent);
  if (size > kLargestSize) {
    return found +
           "; if the mesh file is in millimetres or centimetres, set mesh.unit = \"mm\" or "
           "\"cm\"";
  }
  return found + "; if the mesh file is in larger units, mind mesh.unit (\"m\" unless given)";
}

}  // namespace irdm::precompute
