#include "server/collision/deformed_surface.hpp"

#include <algorithm>
#include <cmath>

namespace irdm {
namespace {
// Enough to cross a dozen triangles from a good start, and a bound on the cost of a bad one.
constexpr int kMaxMoves = 16;
}  // namespace

DeformedSurface::DeformedSurface(const ModelMesh& mesh)
    : mesh_(mesh),
      tree_(mesh),
      topology_(mesh),
      known_in_(static_cast<std::size_t>(mesh.surface_node_count()), 0),
      positions_(static_cast<std::size_t>(mesh.surface_node_count()), Vector3::Zero()) {}

void DeformedSurface::begin_step(const ResponseEngine& engine) noexcept {
  engine_ = &engine;
  ++step_;
}

const Vector3& DeformedSurface::node(int i) noexcept {
  const auto index = static_cast<std::size_t>(i);
  if (known_in_[index] != step_) {
    positions_[index] = mesh_.rest_position(i) + engine_->free_displacement(i);
    known_in_[index] = step_;
  }
  return positions_[index];
}

TriangleCorners DeformedSurface::corners(int triangle) noexcept {
  const std::array<int, 3>& nodes = topology_.corners(triangle);
  return {node(nodes[0]), node(nodes[1]), node(nodes[2])};
}

Vector3 DeformedSurface::normal(int triangle) noexcept {
  return area_normal(corners(triangle)).normalized();
}

SurfaceHit DeformedSurface::hit_on(int triangle, const Vector3& p) noexcept {
  const TriangleCorners deformed = corners(triangle);
  SurfaceHit hit;
  hit.triangle = triangle;
  hit.point = {topology_.corners(triangle), closest_point(deformed, p)};
  hit.position = at(deformed, hit.point.weights);
  hit.signed_distance = (p - hit.position).norm();
  return hit;
}

template <typename Visit>
void DeformedSurface::visit_neighbours(int triangle, const Visit& visit) noexcept {
  for (const int corner : topology_.corners(triangle)) {
    for (const int neighbour : topology_.triangles_around(corner)) {
      if (neighbour != triangle) visit(neighbour);
    }
  }
}

SurfaceHit DeformedSurface::descend(SurfaceHit best, const Vector3& p) noexcept {
  for (int move = 0; move < kMaxMoves; ++move) {
    const int here = best.triangle;
    visit_neighbours(here, [&](int neighbour) {
      const SurfaceHit hit = hit_on(neighbour, p);
      if (hit.signed_distance < best.signed_distance) best = hit;
    });
    if (best.triangle == here) break;
  }
  return best;
}

// Normal of the feature (face, edge or corner) that the nearest point lies on. Weighting the faces
// round a corner by their angle makes its sign the right one for inside and outside.
Vector3 DeformedSurface::pseudonormal(const SurfaceHit& hit) noexcept {
  std::array<int, 3> on{};  // nodes of the feature: 1 corner, 2 edge, 3 face
  std::size_t count = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    if (hit.point.weights[i] > 0) on[count++] = hit.point.nodes[i];
  }
  if (count == 3) return normal(hit.triangle);
  Vector3 sum = Vector3::Zero();
  for (const int triangle : topology_.triangles_around(on[0])) {
    const std::array<int, 3>& nodes = topology_.corners(triangle);
    const TriangleCorners deformed = corners(triangle);
    const Vector3 unit = area_normal(deformed).normalized();
    if (count == 2) {
      if (std::find(nodes.begin(), nodes.end(), on[1]) != nodes.end()) sum += unit;
      continue;
    }
    const auto corner =
        static_cast<std::size_t>(std::find(nodes.begin(), nodes.end(), on[0]) - nodes.begin());
    const Vector3 a = deformed[(corner + 1) % 3] - deformed[corner];
    const Vector3 b = deformed[(corner + 2) % 3] - deformed[corner];
    sum += std::atan2(a.cross(b).norm(), a.dot(b)) * unit;
  }
  return sum;
}

SurfaceHit DeformedSurface::closest(const Vector3& p) noexcept {
  SurfaceHit best = hit_on(tree_.closest_triangle(p), p);
  // Where the surface is displaced by u, the rest surface below p - u is the better place to start.
  const Vector3 u =
      interpolate(best.point, [&](int i) -> Vector3 { return node(i) - mesh_.rest_position(i); });
  const SurfaceHit shifted = hit_on(tree_.closest_triangle(p - u), p);
  if (shifted.signed_distance < best.signed_distance) best = shifted;
  best = descend(best, p);
  if (pseudonormal(best).dot(p - best.position) < 0) best.signed_distance = -best.signed_distance;
  return best;
}

std::optional<SurfacePoint> DeformedSurface::entry(int near, const Vector3& from, const Vector3& to,
                                                   int& triangle) noexcept {
  std::optional<SurfacePoint> found;
  double earliest = 2.0;
  const auto consider = [&](int candidate) {
    const std::optional<Crossing> here = crossing(corners(candidate), from, to);
    if (!here || here->fraction >= earliest) return;
    earliest = here->fraction;
    found = SurfacePoint{topology_.corners(candidate), here->weights};
    triangle = candidate;
  };
  consider(near);
  visit_neighbours(near, consider);
  return found;
}

}  // namespace irdm
