#include "precompute/dynamics/soft_body.hpp"

#include "precompute/dynamics/polar_rotation.hpp"
#include "precompute/fem/assembly.hpp"
#include "precompute/fem/mass_properties.hpp"

namespace irdm::precompute {
namespace {

Eigen::Map<const Points> as_points(const Eigen::VectorXd& field) {
  return {field.data(), field.size() / 3, 3};
}

// S - Id of the stretch S, without the cancellation that would leave 1e-16 of noise in strains of
// any size: (S - Id)(S + Id) = F^T F - Id, and that is H + H^T + H^T H.
Matrix3 stretch_strain(const Matrix3& du_dX, const Matrix3& S) {
  const Matrix3 squared = du_dX + du_dX.transpose() + du_dX.transpose() * du_dX;
  const Matrix3 strain = squared * (S + Matrix3::Identity()).inverse();
  return 0.5 * (strain + strain.transpose());
}

// The vector a with skew(a) = m - m^T.
Vector3 twice_axial(const Matrix3& m) {
  return {m(2, 1) - m(1, 2), m(0, 2) - m(2, 0), m(1, 0) - m(0, 1)};
}

}  // namespace

SoftBody::SoftBody(const TetMesh& mesh, const Material& material, Elasticity elasticity)
    : elasticity_(elasticity),
      material_(material),
      lame_(lame_parameters(material)),
      mass_(lumped_mass(mesh, material.density)) {
  rest_ =
      mesh.nodes.rowwise() - nodal_mass_properties(mesh.nodes, mass_).centre_of_mass.transpose();
  elements_.resize(static_cast<std::size_t>(mesh.tet_count()));
  for (int e = 0; e < mesh.tet_count(); ++e) {
    Element& element = elements_[static_cast<std::size_t>(e)];
    tet4::Corners corners;
    for (int i = 0; i < 4; ++i) {
      element.nodes[static_cast<std::size_t>(i)] = mesh.tets(e, i);
      corners.row(i) = rest_.row(mesh.tets(e, i));
    }
    element.geometry = tet4::geometry(corners);
  }
}

double SoftBody::volume() const {
  double sum = 0.0;
  for (const Element& element : elements_) sum += element.geometry.volume;
  return sum;
}

BodyState SoftBody::at_rest() const {
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(3 * rest_.rows());
  return {zero, zero};
}

Matrix3 SoftBody::gradient(const Element& element, const Eigen::VectorXd& field) const {
  Matrix3 sum = Matrix3::Zero();
  for (int i = 0; i < 4; ++i) {
    sum += field.segment<3>(3 * element.nodes[static_cast<std::size_t>(i)]) *
           element.geometry.gradient.row(i);
  }
  return sum;
}

Matrix3 SoftBody::stress(const Matrix3& strain) const {
  return lame_.lambda * strain.trace() * Matrix3::Identity() + 2.0 * lame_.mu * strain;
}

Matrix3 SoftBody::first_piola(const Matrix3& du_dX, const Matrix3& dv_dX) const {
  const double beta = material_.rayleigh_beta;
  if (elasticity_ == Elasticity::kLinear) {
    const Matrix3 g = du_dX + beta * dv_dX;
    return stress(0.5 * (g + g.transpose()));
  }
  const Matrix3 F = Matrix3::Identity() + du_dX;
  const Matrix3 R = polar_rotation(F);
  Matrix3 S = R.transpose() * F;
  S = 0.5 * (S + S.transpose()).eval();
  const Matrix3 elastic = stress(stretch_strain(du_dX, S));
  if (beta == 0.0) return R * elastic;
  // A = R^T dF/dt = dS/dt + W S with W = R^T dR/dt skew; that dS/dt is symmetric gives
  // (tr(S) Id - S) w = twice_axial(A). The stress whose power is T : dS/dt is R (T + skew(c)).
  const Matrix3 A = R.transpose() * dv_dX;
  const Matrix3 G = S.trace() * Matrix3::Identity() - S;
  const Matrix3 inverse_G = G.inverse();
  const Matrix3 S_rate = A - skew(inverse_G * twice_axial(A)) * S;
  const Matrix3 T = beta * stress(0.5 * (S_rate + S_rate.transpose()));
  return R * (elastic + T + skew(inverse_G * twice_axial(S * T)));
}

Eigen::VectorXd SoftBody::internal_force(const BodyState& state) const {
  Eigen::VectorXd force = Eigen::VectorXd::Zero(state.u.size());
  for (const Element& element : elements_) {
    const Matrix3 P = first_piola(gradient(element, state.u), gradient(element, state.v));
    const Matrix3 weighted = -element.geometry.volume * P;
    for (int i = 0; i < 4; ++i) {
      force.segment<3>(3 * element.nodes[static_cast<std::size_t>(i)]) +=
          weighted * element.geometry.gradient.row(i).transpose();
    }
  }
  if (material_.rayleigh_alpha > 0.0) {
    const Eigen::VectorXd elastic = state.v - rigid_velocity(state.u, state.v);
    for (Eigen::Index i = 0; i < mass_.size(); ++i) {
      force.segment<3>(3 * i) -= material_.rayleigh_alpha * mass_(i) * elastic.segment<3>(3 * i);
    }
  }
  return force;
}

double SoftBody::elastic_energy(const Eigen::VectorXd& u) const {
  double sum = 0.0;
  for (const Element& element : elements_) {
    const Matrix3 du_dX = gradient(element, u);
    Matrix3 strain = 0.5 * (du_dX + du_dX.transpose());
    if (elasticity_ == Elasticity::kCorotational) {
      const Matrix3 F = Matrix3::Identity() + du_dX;
      strain = stretch_strain(du_dX, polar_rotation(F).transpose() * F);
    }
    sum += element.geometry.volume *
           (lame_.mu * strain.squaredNorm() + 0.5 * lame_.lambda * strain.trace() * strain.trace());
  }
  return sum;
}

double SoftBody::kinetic_energy(const Eigen::VectorXd& v) const {
  return 0.5 * mass_.dot(as_points(v).rowwise().squaredNorm());
}

Vector3 SoftBody::momentum(const Eigen::VectorXd& v) const {
  return as_points(v).transpose() * mass_;
}

Vector3 SoftBody::angular_momentum(const BodyState& state) const {
  Vector3 sum = Vector3::Zero();
  for (Eigen::Index i = 0; i < mass_.size(); ++i) {
    const Vector3 x = rest_.row(i).transpose() + state.u.segment<3>(3 * i);
    sum += mass_(i) * x.cross(state.v.segment<3>(3 * i));
  }
  return sum;
}

Eigen::SparseMatrix<double> SoftBody::stiffness(const Eigen::VectorXd& u) const {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(elements_.size() * 144);
  for (const Element& element : elements_) {
    Matrix3 R = Matrix3::Identity();
    if (elasticity_ == Elasticity::kCorotational) {
      R = polar_rotation(Matrix3::Identity() + gradient(element, u));
    }
    // An isotropic element turns with its shape functions' gradients.
    tet4::Geometry turned = element.geometry;
    turned.gradient = element.geometry.gradient * R.transpose();
    const tet4::Stiffness k = tet4::stiffness(turned, lame_);
    for (int row = 0; row < 12; ++row) {
      for (int column = 0; column < 12; ++column) {
        entries.emplace_back(3 * element.nodes[static_cast<std::size_t>(row / 3)] + row % 3,
                             3 * element.nodes[static_cast<std::size_t>(column / 3)] + column % 3,
                             k(row, column));
      }
    }
  }
  Eigen::SparseMatrix<double> matrix(u.size(), u.size());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

Eigen::VectorXd SoftBody::rigid_velocity(const Eigen::VectorXd& u, const Eigen::VectorXd& v) const {
  Points x = rest_;
  if (elasticity_ == Elasticity::kCorotational) x += as_points(u);
  const double total = mass_.sum();
  const Vector3 centre = x.transpose() * mass_ / total;
  const Vector3 velocity = as_points(v).transpose() * mass_ / total;
  Matrix3 inertia = Matrix3::Zero();
  Vector3 spin = Vector3::Zero();
  for (Eigen::Index i = 0; i < mass_.size(); ++i) {
    const Vector3 arm = x.row(i).transpose() - centre;
    inertia += mass_(i) * (arm.squaredNorm() * Matrix3::Identity() - arm * arm.transpose());
    spin += mass_(i) * arm.cross(v.segment<3>(3 * i) - velocity);
  }
  const Vector3 omega = inertia.ldlt().solve(spin);
  Eigen::VectorXd rigid(v.size());
  for (Eigen::Index i = 0; i < mass_.size(); ++i) {
    rigid.segment<3>(3 * i) = velocity + omega.cross(x.row(i).transpose() - centre);
  }
  return rigid;
}

}  // namespace irdm::precompute
