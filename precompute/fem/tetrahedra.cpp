#include "precompute/fem/tetrahedra.hpp"

#include "precompute/fem/material.hpp"
#include "precompute/mesh/tet_mesh.hpp"

namespace irdm::precompute::tet4 {

Geometry geometry(const Corners& corners) {
  // Barycentric coordinates of x: edges^T b = x - corner 0, so the gradients of b1..b3 are the rows
  // of the inverse transpose, and all four gradients sum to zero.
  const Matrix3 edges = corners.bottomRows<3>().rowwise() - corners.row(0);
  Geometry g;
  g.volume = edges.determinant() / 6.0;
  g.gradient.bottomRows<3>() = edges.inverse().transpose();
  g.gradient.row(0) = -g.gradient.bottomRows<3>().colwise().sum();
  return g;
}

Matrix3 stress(const Geometry& geometry, const Lame& lame, const Displacements& displacements) {
  return lame_stress(displacements.transpose() * geometry.gradient, lame);
}

Stiffness stiffness(const Geometry& geometry, const Lame& lame) {
  Stiffness k = Stiffness::Zero();
  add_strain_energy(geometry.gradient, geometry.volume, lame, k);
  return k;
}

}  // namespace irdm::precompute::tet4

namespace irdm::precompute::tet10 {
namespace {

// Barycentric coordinates (a, b, b, b) of the rule of degree 2: a = (5 + 3 sqrt 5) / 20.
constexpr double kNear = 0.58541019662496845446;
constexpr double kFar = 0.13819660112501051518;

}  // namespace

Gradients gradients(const tet4::Geometry& geometry, const Barycentric& b) {
  Gradients g;
  for (int i = 0; i < 4; ++i) g.row(i) = (4.0 * b(i) - 1.0) * geometry.gradient.row(i);
  int node = 4;
  for (const auto& [i, j] : kTetEdges) {
    g.row(node++) = 4.0 * (b(i) * geometry.gradient.row(j) + b(j) * geometry.gradient.row(i));
  }
  return g;
}

std::array<Barycentric, 4> quadrature_points() {
  std::array<Barycentric, 4> points;
  for (int i = 0; i < 4; ++i) {
    points[static_cast<std::size_t>(i)].setConstant(kFar);
    points[static_cast<std::size_t>(i)](i) = kNear;
  }
  return points;
}

Matrix3 stress(const tet4::Geometry& geometry, const Barycentric& b, const Lame& lame,
               const Displacements& displacements) {
  return lame_stress(displacements.transpose() * gradients(geometry, b), lame);
}

tet4::Geometry geometry(const TetMesh& mesh, int e, const Barycentric& b) {
  if (is_straight(mesh, e)) return tet4::geometry(corners_of(mesh, e));
  // A tetrahedron with the same map, whose first corner is the origin.
  tet4::Corners corners = tet4::Corners::Zero();
  corners.bottomRows<3>() = jacobian(mesh, e, b).transpose();
  return tet4::geometry(corners);
}

Stiffness stiffness(const TetMesh& mesh, int e, const Lame& lame) {
  Stiffness k = Stiffness::Zero();
  for (const Barycentric& b : quadrature_points()) {
    const tet4::Geometry near = geometry(mesh, e, b);
    add_strain_energy<10>(gradients(near, b), 0.25 * near.volume, lame, k);
  }
  return k;
}

Eigen::Matrix<double, 10, 1> mass_shares() {
  // Integrals of the squared shape functions: V 6 / 420 at a corner, V 32 / 420 at a mid-side node.
  Eigen::Matrix<double, 10, 1> shares;
  shares << Eigen::Vector4d::Constant(6.0), Eigen::Matrix<double, 6, 1>::Constant(32.0);
  return shares / shares.sum();
}

}  // namespace irdm::precompute::tet10

namespace irdm::precompute {

tet4::Corners corners_of(const TetMesh& mesh, int e) {
  tet4::Corners corners;
  for (int i = 0; i < 4; ++i) corners.row(i) = mesh.nodes.row(mesh.tets(e, i));
  return corners;
}

double element_volume(const TetMesh& mesh, int e) {
  if (is_straight(mesh, e)) return signed_volume(mesh, e);
  double sum = 0.0;
  for (const tet10::Barycentric& b : tet10::quadrature_points()) {
    sum += 0.25 * tet10::geometry(mesh, e, b).volume;
  }
  return sum;
}

}  // namespace irdm::precompute
