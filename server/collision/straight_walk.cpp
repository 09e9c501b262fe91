#include "server/collision/straight_walk.hpp"

#include <algorithm>

namespace irdm {
namespace {

// How the weights of a point change as it moves along d in the triangle's plane [1/m].
Barycentric weight_rates(const TriangleCorners& triangle, const Vector3& d) noexcept {
  const Vector3 normal = area_normal(triangle);
  const double scale = 1.0 / normal.squaredNorm();
  Barycentric rates;
  for (std::size_t i = 0; i < 3; ++i) {
    rates[i] = scale * normal.cross(triangle[(i + 2) % 3] - triangle[(i + 1) % 3]).dot(d);
  }
  return rates;
}

// The same point on an edge, with the nodes of the triangle beyond it.
SurfacePoint carried_over(const SurfacePoint& point, const std::array<int, 3>& nodes) noexcept {
  SurfacePoint carried{nodes, {0.0, 0.0, 0.0}};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      if (point.nodes[j] == nodes[i]) carried.weights[i] = point.weights[j];
    }
  }
  return carried;
}

}  // namespace

StraightWalk::StraightWalk(const RestSurface& surface, const SurfaceLocation& from,
                           const Vector3& direction) noexcept
    : surface_(surface), here_(from), start_(from.position) {
  enter(from.triangle);
  ahead_ = direction - direction.dot(triangle_normal_) * triangle_normal_;
  moves_ = ahead_.norm() > 1e-12 * direction.norm();
  if (moves_) ahead_.normalize();
  heading_ = ahead_;
  normal_ = triangle_normal_;
}

void StraightWalk::enter(int triangle) noexcept {
  here_.triangle = triangle;
  corners_ = surface_.corners(triangle);
  triangle_normal_ = area_normal(corners_).normalized();
}

double StraightWalk::leg(double length) noexcept {
  start_ = here_.position;
  heading_ = ahead_;
  normal_ = triangle_normal_;
  const Barycentric rates = weight_rates(corners_, heading_);
  std::size_t corner = 3;  // whose opposite edge is reached first
  double way = length;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!(rates[i] < 0)) continue;
    const double until = std::max(0.0, -here_.point.weights[i] / rates[i]);
    if (until < way) {
      way = until;
      corner = i;
    }
  }
  for (std::size_t i = 0; i < 3; ++i) {
    here_.point.weights[i] = std::max(0.0, here_.point.weights[i] + way * rates[i]);
  }
  here_.position = start_ + way * heading_;
  if (corner < 3) cross(corner);
  return way;
}

void StraightWalk::cross(std::size_t corner) noexcept {
  const Vector3 edge = (corners_[(corner + 2) % 3] - corners_[(corner + 1) % 3]).normalized();
  const double along = heading_.dot(edge);
  const double over = heading_.dot(edge.cross(normal_));
  here_.point.weights[corner] = 0.0;
  const int next = surface_.across(here_.triangle, corner);
  here_.point = carried_over(here_.point, surface_.topology().corners(next));
  enter(next);
  ahead_ = along * edge + over * edge.cross(triangle_normal_);
}

}  // namespace irdm
