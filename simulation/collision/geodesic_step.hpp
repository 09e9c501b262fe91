#pragma once

#include "simulation/collision/rest_surface.hpp"

namespace irdm {

/// A straight way along the surface at rest: within each triangle a straight line, over an edge as
/// if the two triangles were unfolded into a plane. Leg by leg, one triangle each. Real-time safe.
class GeodesicStep {
 public:
  /// @param direction of the first leg, as far as it lies in the plane of the triangle [m, B]
  /// @param surface must outlive this object
  GeodesicStep(const RestSurface& surface, const SurfaceLocation& from,
               const Vector3& direction) noexcept;

  /// False: the direction was normal to the triangle, and there is nowhere to go.
  bool moves() const noexcept { return moves_; }
  /// Goes on to the next edge, and over it, but not farther than `length`. Returns how far [m].
  double leg(double length) noexcept;

  const SurfaceLocation& here() const noexcept { return here_; }
  /// Where the last leg began, its direction and its triangle's outward normal (units, B).
  const Vector3& start() const noexcept { return start_; }
  const Vector3& heading() const noexcept { return heading_; }
  const Vector3& normal() const noexcept { return normal_; }

 private:
  void enter(int triangle) noexcept;
  void cross(std::size_t corner) noexcept;

  const RestSurface& surface_;
  SurfaceLocation here_;
  Vector3 start_, heading_, normal_;
  const RestSurface::Plane* plane_ = nullptr;  ///< of the leg to come ...
  Vector3 ahead_;                              ///< ... and its direction
  bool moves_ = true;
};

}  // namespace irdm
