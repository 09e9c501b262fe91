#include "precompute/mesh/round_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "precompute/mesh/box_mesh.hpp"

namespace irdm::precompute {
namespace {

// Places on the faces of the cube [-1, 1]^3, bent onto the sphere: the lines through the middle of
// a face are divided into equal angles.
Vector3 on_sphere(const Vector3& s) {
  const Vector3 angle = 0.25 * std::numbers::pi * s;
  return Vector3(std::tan(angle.x()), std::tan(angle.y()), std::tan(angle.z())).normalized();
}

}  // namespace

SurfaceMesh sphere_surface(int cells) {
  SurfaceMesh surface = box_surface(Vector3::Constant(2.0), {cells, cells, cells});
  for (Eigen::Index i = 0; i < surface.nodes.rows(); ++i) {
    const Vector3 s = surface.nodes.row(i).transpose() - Vector3::Ones();
    surface.nodes.row(i) = on_sphere(s).transpose();
  }
  return surface;
}

double capsule_rows(double length, int cells) {
  return 2.0 * std::max(1.0, std::round(cells * length / std::numbers::pi));
}

// In the box below y counts rows: those of a half sphere beside its last face, of the cylinder, and
// of the other half sphere.
SurfaceMesh capsule_surface(double length, int cells) {
  const int rows = static_cast<int>(capsule_rows(length, cells));
  const int cap = (cells + 1) / 2;
  const int all = 2 * cap + rows;
  SurfaceMesh surface = box_surface(Vector3(2.0, all, 2.0), {cells, all, cells});
  for (Eigen::Index i = 0; i < surface.nodes.rows(); ++i) {
    const Vector3 p = surface.nodes.row(i).transpose();
    const double lower = std::min(0.0, p.y() / cap - 1.0);
    const double upper = std::max(0.0, (p.y() - cap - rows) / cap);
    const double along = std::clamp((p.y() - cap) / rows, 0.0, 1.0) - 0.5;
    const Vector3 round = on_sphere(Vector3(p.x() - 1.0, lower + upper, p.z() - 1.0));
    surface.nodes.row(i) = (round + along * length * Vector3::UnitY()).transpose();
  }
  return surface;
}

}  // namespace irdm::precompute
