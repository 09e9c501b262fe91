#include "simulation/collision/geodesic_step.hpp"

#include <algorithm>

namespace irdm {
namespace {

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

GeodesicStep::GeodesicStep(const RestSurface& surface, const SurfaceLocation& from,
                           const Vector3& direction) noexcept
    : surface_(surface), here_(from), start_(from.position) {
  enter(from.triangle);
  ahead_ = direction - direction.dot(plane_->normal) * plane_->normal;
  moves_ = ahead_.norm() > 1e-12 * direction.norm();
  if (moves_) ahead_.normalize();
  heading_ = ahead_;
  normal_ = plane_->normal;
}

void GeodesicStep::enter(int triangle) noexcept {
  here_.triangle = triangle;
  plane_ = &surface_.plane(triangle);
}

double GeodesicStep::leg(double length) noexcept {
  start_ = here_.position;
  heading_ = ahead_;
  normal_ = plane_->normal;
  Barycentric rates;
  for (std::size_t i = 0; i < 3; ++i) rates[i] = plane_->rates[i].dot(heading_);
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

void GeodesicStep::cross(std::size_t corner) noexcept {
  const std::array<int, 3>& nodes = surface_.topology().corners(here_.triangle);
  const Vector3 edge =
      (surface_.node(nodes[(corner + 2) % 3]) - surface_.node(nodes[(corner + 1) % 3]))
          .normalized();
  const double along = heading_.dot(edge);
  const double over = heading_.dot(edge.cross(normal_));
  here_.point.weights[corner] = 0.0;
  const int next = plane_->across[corner];
  here_.point = carried_over(here_.point, surface_.topology().corners(next));
  enter(next);
  ahead_ = along * edge + over * edge.cross(plane_->normal);
}

}  // namespace irdm
