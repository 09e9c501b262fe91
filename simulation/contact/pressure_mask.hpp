#pragma once

#include <vector>

#include "simulation/collision/rest_surface.hpp"
#include "simulation/contact/contact_patch.hpp"

namespace irdm {

/// The pressure of a round fingertip on the surface: with s the distance from the middle over the
/// radius, proportional to 1 - s^2, as under an elastic ball of small stiffness. It is summed at
/// points on rings round the middle, laid along the surface and round its edges; each passes its
/// share to its triangle's corners. So the force spreads alike on any mesh whose edges are not
/// longer than the radius, and moves smoothly with the contact. Where the mesh is so much finer
/// than elsewhere that a patch has no room for those corners, the nearest one gets the share.
/// Radius 0: the point itself.
/// Real-time safe after construction; one thread.
class PressureMask {
 public:
  /// The largest radius for a surface [m]: beyond it nodes would lie between the rings.
  static double largest_radius(const RestSurface& surface) noexcept;

  /// @param radius [m], 0..largest_radius(surface)
  /// @param surface must outlive this object
  PressureMask(const RestSurface& surface, double radius);

  double radius() const noexcept { return radius_; }
  /// The nodes under a fingertip whose middle is at a point of the surface. As long as that stays
  /// it is copied.
  void spread(const SurfacePoint& middle, ContactPatch& patch) noexcept;

 private:
  struct Sample {
    double cosine, sine;  ///< of its direction from the middle
    double distance;      ///< along the surface [m]
    double weight;        ///< share of the force
  };
  /// One way to pass a sample's weight on; false: the patch has no room.
  using AddSample = bool (PressureMask::*)(const SurfacePoint&, double, ContactPatch&) noexcept;
  bool add(int node, double weight, ContactPatch& patch) noexcept;
  bool add_to_corners(const SurfacePoint& at, double weight, ContactPatch& patch) noexcept;
  bool add_to_nearest(const SurfacePoint& at, double weight, ContactPatch& patch) noexcept;
  void normalise(ContactPatch& patch) noexcept;
  void lay(const SurfacePoint& middle, ContactPatch& patch) noexcept;
  bool lay(const SurfacePoint& middle, AddSample add_sample, ContactPatch& patch) noexcept;

  const RestSurface& surface_;
  double radius_;
  std::vector<Sample> samples_;
  std::vector<int> slot_;  ///< of a node in the patch under construction; -1: not there
  SurfacePoint middle_;    ///< that laid_ lies about
  ContactPatch laid_;      ///< empty: none
};

}  // namespace irdm
