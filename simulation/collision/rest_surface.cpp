#include "simulation/collision/rest_surface.hpp"

#include <algorithm>
#include <cmath>

#include "simulation/collision/geodesic_step.hpp"

namespace irdm {
namespace {
// Bounds the way of one step; a tip at 2 m/s passes far fewer triangles in 2 ms.
constexpr int kMaxWalkMoves = 64;

bool contains(const std::array<int, 3>& nodes, int node) noexcept {
  return std::find(nodes.begin(), nodes.end(), node) != nodes.end();
}

}  // namespace

RestSurface::RestSurface(const ModelMesh& mesh) : tree_(mesh), topology_(mesh) {
  for (int i = 0; i < mesh.surface_node_count(); ++i) positions_.push_back(mesh.rest_position(i));
  normals_.assign(positions_.size(), Vector3::Zero());
  double edges = 0.0;
  for (int t = 0; t < static_cast<int>(mesh.triangles.rows()); ++t) {
    const TriangleCorners triangle = corners(t);
    const Vector3 twice_area = area_normal(triangle);
    const Vector3 normal = twice_area.normalized();
    Plane& plane = planes_.emplace_back();
    plane.normal = normal;
    for (std::size_t i = 0; i < 3; ++i) {
      plane.rates[i] = (triangle[(i + 2) % 3] - triangle[(i + 1) % 3]).cross(twice_area) /
                       -twice_area.squaredNorm();
      plane.across[i] = neighbour(t, i);
      const Vector3 a = triangle[(i + 1) % 3] - triangle[i];
      const Vector3 b = triangle[(i + 2) % 3] - triangle[i];
      edges += a.norm();
      mean_square_edge_ += a.squaredNorm();
      const auto node = static_cast<std::size_t>(topology_.corners(t)[i]);
      normals_[node] += std::atan2(a.cross(b).norm(), a.dot(b)) * normal;
    }
  }
  for (Vector3& normal : normals_) normal.normalize();
  mean_square_edge_ /= static_cast<double>(3 * mesh.triangles.rows());
  mean_edge_ = edges / static_cast<double>(3 * mesh.triangles.rows());
}

TriangleCorners RestSurface::corners(int triangle) const noexcept {
  const std::array<int, 3>& nodes = topology_.corners(triangle);
  return {node(nodes[0]), node(nodes[1]), node(nodes[2])};
}

SurfaceLocation RestSurface::on(int triangle, const Vector3& p) const noexcept {
  const TriangleCorners here = corners(triangle);
  const Barycentric weights = closest_point(here, p);
  return {triangle, {topology_.corners(triangle), weights}, at(here, weights)};
}

SurfaceLocation RestSurface::closest(const Vector3& p) const noexcept {
  return on(tree_.closest_triangle(p), p);
}

SurfaceLocation RestSurface::walk(int triangle, const Vector3& p) const noexcept {
  SurfaceLocation best = on(triangle, p);
  double best_distance2 = (best.position - p).squaredNorm();
  for (int move = 0; move < kMaxWalkMoves; ++move) {
    const int here = best.triangle;
    for (const int corner : topology_.corners(here)) {
      for (const int neighbour : topology_.triangles_around(corner)) {
        if (neighbour == here) continue;
        const SurfaceLocation candidate = on(neighbour, p);
        const double distance2 = (candidate.position - p).squaredNorm();
        if (distance2 < best_distance2) {
          best = candidate;
          best_distance2 = distance2;
        }
      }
    }
    if (best.triangle == here) break;
  }
  return best;
}

SurfaceLocation RestSurface::locate(const SurfacePoint& point) const noexcept {
  SurfaceLocation found;
  found.point = point;
  for (std::size_t i = 0; i < 3; ++i) found.position += point.weights[i] * node(point.nodes[i]);
  for (const int candidate : topology_.triangles_around(point.nodes[0])) {
    const std::array<int, 3>& nodes = topology_.corners(candidate);
    if (contains(nodes, point.nodes[1]) && contains(nodes, point.nodes[2])) {
      found.triangle = candidate;
    }
  }
  return found;
}

int RestSurface::neighbour(int triangle, std::size_t corner) const noexcept {
  const std::array<int, 3>& nodes = topology_.corners(triangle);
  const int a = nodes[(corner + 1) % 3];
  const int b = nodes[(corner + 2) % 3];
  for (const int candidate : topology_.triangles_around(a)) {
    if (candidate != triangle && contains(topology_.corners(candidate), b)) return candidate;
  }
  return triangle;
}

SurfaceLocation RestSurface::straight_on(const SurfaceLocation& from, const Vector3& direction,
                                         double length) const noexcept {
  GeodesicStep walk(*this, from, direction);
  for (int leg = 0; leg < kMaxWalkMoves && length > 0.0 && walk.moves(); ++leg) {
    length -= walk.leg(length);
  }
  return walk.here();
}

Vector3 RestSurface::smooth_normal(const SurfacePoint& point) const noexcept {
  Vector3 sum = Vector3::Zero();
  for (std::size_t i = 0; i < 3; ++i) {
    sum += point.weights[i] * normals_[static_cast<std::size_t>(point.nodes[i])];
  }
  return sum.normalized();
}

}  // namespace irdm
