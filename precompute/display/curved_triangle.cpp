#include "precompute/display/curved_triangle.hpp"

namespace irdm::precompute {
namespace {

// A third of the way from a corner to another, in the plane of the corner's tangents.
Vector3 third(const Vector3& from, const Vector3& to, const Vector3& normal, bool straight) {
  const double out_of_plane = straight ? 0.0 : (to - from).dot(normal);
  return (2.0 * from + to - out_of_plane * normal) / 3.0;
}

}  // namespace

CurvedTriangle::CurvedTriangle(const std::array<Vector3, 3>& corners,
                               const std::array<Vector3, 3>& normals,
                               const std::array<bool, 3>& straight)
    : corners_(corners) {
  Vector3 edge_mean = Vector3::Zero();
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t next = (i + 1) % 3;
    edges_[i] = {third(corners[i], corners[next], normals[i], straight[i]),
                 third(corners[next], corners[i], normals[next], straight[i])};
    edge_mean += (edges_[i][0] + edges_[i][1]) / 6.0;
  }
  const Vector3 flat = (corners[0] + corners[1] + corners[2]) / 3.0;
  middle_ = edge_mean + 0.5 * (edge_mean - flat);
}

Vector3 CurvedTriangle::at(const Vector3& weights) const {
  Vector3 sum = 6.0 * weights.prod() * middle_;
  for (std::size_t i = 0; i < 3; ++i) {
    const double here = weights(static_cast<Eigen::Index>(i));
    const double next = weights(static_cast<Eigen::Index>((i + 1) % 3));
    sum += here * here * here * corners_[i] + 3.0 * here * here * next * edges_[i][0] +
           3.0 * here * next * next * edges_[i][1];
  }
  return sum;
}

}  // namespace irdm::precompute
