#include "precompute/dynamics/soft_body.hpp"

#include "precompute/dynamics/corotational.hpp"
#include "precompute/dynamics/neo_hookean.hpp"
#include "precompute/fem/assembly.hpp"
#include "precompute/fem/mass_properties.hpp"
#include "precompute/fem/tetrahedra.hpp"

namespace irdm::precompute {
SoftBody::SoftBody(const TetMesh& mesh, const Material& material, Elasticity elasticity)
    : elasticity_(elasticity),
      rayleigh_alpha_(material.rayleigh_alpha),
      rayleigh_beta_(material.rayleigh_beta),
      mass_(lumped_mass(mesh, material)) {
  rest_ =
      mesh.nodes.rowwise() - nodal_mass_properties(mesh.nodes, mass_).centre_of_mass.transpose();
  tets_ = mesh.tets;
  for (Eigen::Index e = 0; e < tets_.rows(); ++e) {
    add_element(mesh, e, lame_parameters(material, e));
  }
}

void SoftBody::add_element(const TetMesh& mesh, Eigen::Index element, const Lame& lame) {
  const int e = static_cast<int>(element);
  if (mesh.order() == 1) {
    const tet4::Geometry geometry = tet4::geometry(corners_of(mesh, e));
    points_.push_back({element, lame, geometry.volume, geometry.gradient});
    return;
  }
  for (const tet10::Barycentric& b : tet10::quadrature_points()) {
    const tet4::Geometry near = tet10::geometry(mesh, e, b);
    points_.push_back({element, lame, 0.25 * near.volume, tet10::gradients(near, b)});
  }
}

double SoftBody::volume() const {
  double sum = 0.0;
  for (const Point& point : points_) sum += point.volume;
  return sum;
}

BodyState SoftBody::at_rest() const {
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(3 * rest_.rows());
  return {zero, zero};
}

Matrix3 SoftBody::gradient(const Point& point, const Eigen::VectorXd& field) const {
  Matrix3 sum = Matrix3::Zero();
  for (Eigen::Index i = 0; i < tets_.cols(); ++i) {
    sum += field.segment<3>(3 * tets_(point.element, i)) * point.gradient.row(i);
  }
  return sum;
}

void SoftBody::add_force(const Point& point, const Matrix3& P, Eigen::VectorXd& force) const {
  const Matrix3 weighted = -point.volume * P;
  for (Eigen::Index i = 0; i < tets_.cols(); ++i) {
    force.segment<3>(3 * tets_(point.element, i)) += weighted * point.gradient.row(i).transpose();
  }
}

void SoftBody::add_mass_damping(const BodyState& state, Eigen::VectorXd& force) const {
  if (rayleigh_alpha_ == 0.0) return;
  const Eigen::VectorXd elastic = state.v - rigid_velocity(state.u, state.v);
  for (Eigen::Index i = 0; i < mass_.size(); ++i) {
    force.segment<3>(3 * i) -= rayleigh_alpha_ * mass_(i) * elastic.segment<3>(3 * i);
  }
}

Matrix3 SoftBody::stress(const Point& point, const BodyState& state) const {
  const Matrix3 du_dX = gradient(point, state.u);
  const Matrix3 dv_dX = gradient(point, state.v);
  const double beta = rayleigh_beta_;
  switch (elasticity_) {
    case Elasticity::kLinear:
      return lame_stress(du_dX + beta * dv_dX, point.lame);
    case Elasticity::kCorotational:
      return corotational::stress(du_dX, dv_dX, point.lame, beta);
    case Elasticity::kNeoHookean:
      break;
  }
  return neo_hookean::stress(du_dX, dv_dX, point.lame, beta);
}

Eigen::VectorXd SoftBody::internal_force(const BodyState& state) const {
  Eigen::VectorXd force = Eigen::VectorXd::Zero(state.u.size());
  for (const Point& point : points_) {
    add_force(point, stress(point, state), force);
  }
  add_mass_damping(state, force);
  return force;
}

StepStart SoftBody::start_of_step(const Eigen::VectorXd& u) const {
  StepStart start{u, {}};
  if (elasticity_ != Elasticity::kCorotational) return start;
  start.strains.reserve(points_.size());
  for (const Point& point : points_) {
    start.strains.push_back(corotational::strain(gradient(point, u)));
  }
  return start;
}

Eigen::VectorXd SoftBody::mean_force(const StepStart& start, const Eigen::VectorXd& w,
                                     double h) const {
  const BodyState middle{start.u + 0.5 * h * w, w};
  if (elasticity_ == Elasticity::kLinear) return internal_force(middle);
  const Eigen::VectorXd end = start.u + h * w;
  Eigen::VectorXd force = Eigen::VectorXd::Zero(w.size());
  for (std::size_t p = 0; p < points_.size(); ++p) {
    const Point& point = points_[p];
    const Matrix3 before = gradient(point, start.u);
    const Matrix3 after = gradient(point, end);
    add_force(point,
              elasticity_ == Elasticity::kCorotational
                  ? corotational::mean_stress(before, start.strains[p], after, h, point.lame,
                                              rayleigh_beta_)
                  : neo_hookean::mean_stress(before, after, h, point.lame, rayleigh_beta_),
              force);
  }
  add_mass_damping(middle, force);
  return force;
}

double SoftBody::elastic_energy(const Eigen::VectorXd& u) const {
  double sum = 0.0;
  for (const Point& point : points_) {
    const Matrix3 du_dX = gradient(point, u);
    if (elasticity_ == Elasticity::kNeoHookean) {
      sum += point.volume * neo_hookean::energy_density(du_dX, point.lame);
      continue;
    }
    const Matrix3 strain = elasticity_ == Elasticity::kLinear
                               ? Matrix3(0.5 * (du_dX + du_dX.transpose()))
                               : corotational::strain(du_dX);
    sum += point.volume * corotational::energy_density(strain, point.lame);
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
  const Eigen::Index nodes = tets_.cols();
  entries.reserve(points_.size() * static_cast<std::size_t>(9 * nodes * nodes));
  const auto add = [&](int row, int column, const Matrix3& block) {
    for (int a = 0; a < 3; ++a) {
      for (int b = 0; b < 3; ++b) entries.emplace_back(3 * row + a, 3 * column + b, block(a, b));
    }
  };
  for (const Point& point : points_) {
    const auto add_blocks = [&](const auto& block) {
      for (Eigen::Index i = 0; i < nodes; ++i) {
        for (Eigen::Index j = 0; j < nodes; ++j) {
          add(tets_(point.element, i), tets_(point.element, j),
              point.volume * block(point.gradient.row(i), point.gradient.row(j)));
        }
      }
    };
    if (elasticity_ == Elasticity::kNeoHookean) {
      const neo_hookean::Tangent tangent(gradient(point, u), point.lame);
      add_blocks([&](const Vector3& gi, const Vector3& gj) { return tangent.block(gi, gj); });
      continue;
    }
    Matrix3 R = Matrix3::Identity();
    if (elasticity_ == Elasticity::kCorotational) {
      R = polar_rotation(Matrix3::Identity() + gradient(point, u));
    }
    // An isotropic material turns with its shape functions' gradients: of f_i = stress g_i under
    // the gradient u_j g_j^T.
    add_blocks([&](const Vector3& gi, const Vector3& gj) -> Matrix3 {
      const Matrix3 dyad = (R * gi) * (R * gj).transpose();
      return point.lame.lambda * dyad + point.lame.mu * dyad.transpose() +
             point.lame.mu * dyad.trace() * Matrix3::Identity();
    });
  }
  Eigen::SparseMatrix<double> matrix(u.size(), u.size());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

Eigen::VectorXd SoftBody::rigid_velocity(const Eigen::VectorXd& u, const Eigen::VectorXd& v) const {
  Points x = rest_;
  if (elasticity_ != Elasticity::kLinear) x += as_points(u);
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
