#pragma once

#include <array>

#include "simulation/collision/rest_surface.hpp"

namespace irdm {

/// The surface at rest as a tip feels it that slides on it: with its edges and corners rounded off.
/// The place that belongs to a point of the surface is the mean over a disc laid round it along the
/// surface, with the weights s^4 (1 - s^2)^2, s the distance from the point over the radius; on a
/// flat part it is the point itself. These weights, most of which lie in a soft ring, lead a point
/// round an edge on a curve of nearly even curvature that sets in smoothly: at speed, both a sharp
/// bend and a sudden one change the force from one step to the next. The normal is that of the
/// surface that these places form, so that a force along it does no work in a slip: no energy comes
/// from nowhere. Real-time safe after construction; one thread.
class SmoothedSurface {
 public:
  /// @param tip_radius of the fingertip [m]; where it is small, edges of the mesh set the disc's
  /// @param surface must outlive this object
  SmoothedSurface(const RestSurface& surface, double tip_radius);

  struct Place {
    Vector3 position = Vector3::Zero();  ///< [m], B
    Vector3 normal = Vector3::Zero();    ///< outward, unit, B
  };
  /// Of a point that stays it is found once.
  const Place& at(const SurfacePoint& middle) noexcept;

 private:
  /// Many: each one that comes to lie beyond an edge or on the other side of a corner moves the
  /// mean by a step.
  static constexpr int kRays = 64;
  struct Means {
    Vector3 position = Vector3::Zero();
    Vector3 along_x = Vector3::Zero();
    Vector3 along_y = Vector3::Zero();
  };
  struct Ray {
    double cosine, sine;
  };
  Place find(const SurfacePoint& middle) const noexcept;
  void add_ray(const SurfaceLocation& centre, const Vector3& direction, const Ray& ray,
               Means& means) const noexcept;

  const RestSurface& surface_;
  double radius_;
  std::array<Ray, kRays> rays_;
  bool found_ = false;  ///< any
  SurfacePoint middle_;
  Place place_;  ///< of that
};

}  // namespace irdm
