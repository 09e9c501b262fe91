#include "simulation/contact/fingertip_loads.hpp"

#include "simulation/contact/pressure_mask.hpp"

namespace irdm {
namespace {

SurfacePoint at_node(const RestSurface& surface, int node) {
  const int triangle = surface.topology().triangles_around(node).front();
  SurfacePoint point{surface.topology().corners(triangle), {0.0, 0.0, 0.0}};
  for (std::size_t i = 0; i < 3; ++i) point.weights[i] = point.nodes[i] == node ? 1.0 : 0.0;
  return point;
}

}  // namespace

Eigen::SparseMatrix<double> fingertip_loads(const RestSurface& surface, double radius) {
  const int nodes = surface.node_count();
  PressureMask mask(surface, radius);
  ContactPatch patch;
  std::vector<Eigen::Triplet<double>> entries;
  for (int node = 0; node < nodes; ++node) {
    const SurfacePoint middle = at_node(surface, node);
    const Vector3 normal = surface.smooth_normal(middle);
    mask.spread(middle, patch);
    for (std::size_t i = 0; i < static_cast<std::size_t>(patch.count); ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        entries.emplace_back(3 * patch.nodes[i] + axis, node, patch.weights[i] * normal(axis));
      }
    }
  }
  Eigen::SparseMatrix<double> loads(3 * nodes, nodes);
  loads.setFromTriplets(entries.begin(), entries.end());
  return loads;
}

}  // namespace irdm
