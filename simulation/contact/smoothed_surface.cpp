#include "simulation/contact/smoothed_surface.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulation/collision/rest_surface.hpp"

namespace irdm {
namespace {

// Radius of the disc, over that of the tip: then a fingertip that slides round an edge at 20 cm/s
// changes its force by less than 5 % of the peak in a step of 2 ms.
constexpr double kPerTip = 1.15;
// The same, at least, over the mean edge of the mesh.
constexpr double kPerEdge = 0.8;
// The first ray is turned by this share of the angle between two, so that none runs along the edges
// of a regular mesh.
constexpr double kTurned = 0.3;
// Bounds the legs of a ray.
constexpr int kMaxLegs = 64;

// The share of the weights s^4 (1 - s^2)^2 within s of the middle, and their first moment.
double share(double s) noexcept {
  const double q = s * s;
  return q * q * q * (10.0 + q * (-15.0 + 6.0 * q));
}
double moment(double s) noexcept {
  const double q = s * s;
  return 60.0 * s * q * q * q * (1.0 / 7.0 + q * (-2.0 / 9.0 + q / 11.0));
}

}  // namespace

SmoothedSurface::SmoothedSurface(const RestSurface& surface, double tip_radius)
    : surface_(surface), radius_(std::max(kPerTip * tip_radius, kPerEdge * surface.mean_edge())) {
  for (std::size_t i = 0; i < rays_.size(); ++i) {
    const double angle = 2.0 * std::numbers::pi * (static_cast<double>(i) + kTurned) / kRays;
    rays_[i] = {std::cos(angle), std::sin(angle)};
  }
}

const SmoothedSurface::Place& SmoothedSurface::at(const SurfacePoint& middle) noexcept {
  if (!found_ || middle_.nodes != middle.nodes || middle_.weights != middle.weights) {
    place_ = find(middle);
    middle_ = middle;
    found_ = true;
  }
  return place_;
}

SmoothedSurface::Place SmoothedSurface::find(const SurfacePoint& middle) const noexcept {
  const SurfaceLocation centre = surface_.locate(middle);
  const Vector3 normal = area_normal(surface_.corners(centre.triangle)).normalized();
  const Vector3 x = normal.unitOrthogonal();
  const Vector3 y = normal.cross(x);
  Means means;
  for (const Ray& ray : rays_) add_ray(centre, ray.cosine * x + ray.sine * y, ray, means);
  return {means.position / kRays, means.along_x.cross(means.along_y).normalized()};
}

// Within a leg the place is start + (s - s0) radius heading, and what moves along x or y in the
// middle moves along the same combination of heading and what is beside it: exact integrals over s.
// As the middle moves, every point of the disc moves alike, so the mean of these directions is how
// the place moves.
void SmoothedSurface::add_ray(const SurfaceLocation& centre, const Vector3& direction,
                              const Ray& ray, Means& means) const noexcept {
  GeodesicStep walk(surface_, centre, direction);
  double s = 0.0;
  for (int leg = 0; leg < kMaxLegs && s < 1.0; ++leg) {
    const double way = walk.leg((1.0 - s) * radius_) / radius_;
    const double end = leg + 1 == kMaxLegs ? 1.0 : std::min(1.0, s + way);
    const double weight = share(end) - share(s);
    const Vector3& heading = walk.heading();
    const Vector3 beside = walk.normal().cross(heading);
    means.position += weight * (walk.start() - s * radius_ * heading) +
                      (moment(end) - moment(s)) * radius_ * heading;
    means.along_x += weight * (ray.cosine * heading - ray.sine * beside);
    means.along_y += weight * (ray.sine * heading + ray.cosine * beside);
    s = end;
  }
}

}  // namespace irdm
