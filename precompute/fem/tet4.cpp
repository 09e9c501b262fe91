#include "precompute/fem/tet4.hpp"

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
  const Matrix3 du_dx = displacements.transpose() * geometry.gradient;
  const Matrix3 strain = 0.5 * (du_dx + du_dx.transpose());
  return lame.lambda * strain.trace() * Matrix3::Identity() + 2.0 * lame.mu * strain;
}

Stiffness stiffness(const Geometry& geometry, const Lame& lame) {
  Stiffness k;
  for (int i = 0; i < 4; ++i) {
    const Vector3 gi = geometry.gradient.row(i).transpose();
    for (int j = 0; j < 4; ++j) {
      const Vector3 gj = geometry.gradient.row(j).transpose();
      k.block<3, 3>(3 * i, 3 * j) =
          geometry.volume * (lame.lambda * gi * gj.transpose() +
                             lame.mu * (gj * gi.transpose() + gi.dot(gj) * Matrix3::Identity()));
    }
  }
  return k;
}

}  // namespace irdm::precompute::tet4
