#include "precompute/fem/mass_properties.hpp"

#include <array>

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

void add(const Vector3& x, double mass, Moments& sum) {
  sum.zeroth += mass;
  sum.first += mass * x;
  sum.second += mass * x * x.transpose();
}

// An element with straight edges, exactly.
void add_straight(const TetMesh& mesh, int e, double density, const Vector3& reference,
                  Moments& sum) {
  const double m = density * signed_volume(mesh, e);
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

// One with curved edges, exactly, by five Gauss points along each axis of a cube of which it is the
// image: (u, v, w) with b1 = u, b2 = (1 - u) v, b3 = (1 - u) (1 - v) w.
void add_curved(const TetMesh& mesh, int e, double density, const Vector3& reference,
                Moments& sum) {
  constexpr std::array<double, 5> kAt{0.04691007703066802, 0.23076534494715845, 0.5,
                                      0.76923465505284155, 0.95308992296933198};
  constexpr std::array<double, 5> kWeight{0.11846344252809454, 0.23931433524968324,
                                          0.28444444444444444, 0.23931433524968324,
                                          0.11846344252809454};
  for (int point = 0; point < 125; ++point) {
    const auto i = static_cast<std::size_t>(point % 5);
    const auto j = static_cast<std::size_t>(point / 5 % 5);
    const auto k = static_cast<std::size_t>(point / 25);
    const double left = 1.0 - kAt[i];
    Eigen::Vector4d b;
    b.tail<3>() << kAt[i], left * kAt[j], left * (1.0 - kAt[j]) * kAt[k];
    b(0) = 1.0 - b.tail<3>().sum();
    const double share = kWeight[i] * kWeight[j] * kWeight[k] * left * left * (1.0 - kAt[j]);
    add(place(mesh, e, b) - reference, density * share * jacobian(mesh, e, b).determinant(), sum);
  }
}

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
    const double density = density_of(material, e);
    if (is_straight(mesh, e)) {
      add_straight(mesh, e, density, reference, sum);
    } else {
      add_curved(mesh, e, density, reference, sum);
    }
  }
  return about_centre(sum, reference);
}

MassProperties nodal_mass_properties(const Points& nodes, const Eigen::VectorXd& mass) {
  const Vector3 reference = nodes.colwise().mean().transpose();
  Moments sum;
  for (Eigen::Index i = 0; i < nodes.rows(); ++i) {
    add(nodes.row(i).transpose() - reference, mass(i), sum);
  }
  return about_centre(sum, reference);
}

}  // namespace irdm::precompute
