#include "precompute/fem/tet4.hpp"

#include "precompute/fem/strain_energy.hpp"

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
