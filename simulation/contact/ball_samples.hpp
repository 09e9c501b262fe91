#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "simulation/collision/rest_surface.hpp"

namespace irdm {

/// A sample of the surface for contact with a ball: the centroid of a small part of an element's
/// face. The element's shape functions give its displacement, and its force is distributed to the
/// nodes with the same weights, so that the contact does no spurious work.
struct BallSample {
  SurfaceLocation place;             ///< at rest
  Vector3 normal = Vector3::Zero();  ///< outward, unit, B
  double area = 0.0;                 ///< [m^2]
  double edge = 0.0;                 ///< mean edge length of the face [m]
  int element = -1;                  ///< the element below it; -1 if it is unknown
  int face = 0;                      ///< number of the face; its samples are contiguous
  std::size_t node_count = 3;        ///< 3, or 6 on a quadratic element
  std::array<int, 6> nodes{};
  std::array<double, 6> weights{};
};

/// Returns the sample spacing [m] for a ball of the given radius [m] on a surface of the given area
/// [m^2]: at most a fifth of the radius, within limits on the number of samples of the body.
double ball_sample_spacing(double radius, double area);

/// Divides each face into congruent parts whose area is about the square of `spacing` [m] and
/// returns a sample for each part.
std::vector<BallSample> ball_samples(const ModelMesh& mesh, const RestSurface& surface,
                                     double spacing);

}  // namespace irdm
