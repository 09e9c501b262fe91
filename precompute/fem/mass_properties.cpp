#include "precompute/fem/mass_properties.hpp"

#include "precompute/fem/material.hpp"

namespace irdm::precompute {
namespace {

// Sums of mass, m x and m x x^T about a reference point near the body, so that a body far from the
// origin loses no digits.
struct Moments {
  double zeroth = 0.0;
  Vector3 first = Vector3::Zero();
  Matrix3 second = Matrix3::Zero();
};

MassProperties about_centre(const Moments& m, const Vector3& reference) {
  const Vector3 centre = m.first / m.zeroth;
  const Matrix3 second = m.second - m.zeroth * centre * centre.transpose();
  return {m.zeroth, reference + centre, second.trace() * Matrix3::Identity() - second};
}

}  // namespace

MassProperties solid_mass_properties(const TetMesh& mesh, const Material& material) {
  const Vector3 reference = mesh.nodes.colwise().mean().transpose();
  Moments sum;
  for (int e = 0; e < mesh.tet_count(); ++e) {
    const double m = density_of(material, e) * signed_volume(mesh, e);
    Vector3 corner_sum = Vector3::Zero();
    Matrix3 corner_products = Matrix3::Zero();
    for (int i = 0; i < 4; ++i) {
      const Vector3 x = mesh.position(mesh.tets(e, i)) - reference;
      corner_sum += x;
      corner_products += x * x.transpose();
    }
    sum.zeroth += m;
    sum.first += 0.25 * m * corner_sum;
    // Integral of b_i b_j over a tetrahedron: V (1 + [i = j]) / 20.
    sum.second += 0.05 * m * (corner_products + corner_sum * corner_sum.transpose());
  }
  return about_centre(sum, reference);
}

MassProperties nodal_mass_properties(const Points& nodes, const Eigen::VectorXd& mass) {
  const Vector3 reference = nodes.colwise().mean().transpose();
  Moments sum;
  for (Eigen::Index i = 0; i < nodes.rows(); ++i) {
    const Vector3 x = nodes.row(i).transpose() - reference;
    sum.zeroth += mass(i);
    sum.first += mass(i) * x;
    sum.second += mass(i) * x * x.transpose();
  }
  return about_centre(sum, reference);
}

}  // namespace irdm::precompute
