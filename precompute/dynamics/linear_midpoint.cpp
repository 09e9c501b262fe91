#include "precompute/dynamics/linear_midpoint.hpp"

#include <cassert>

#include "precompute/dynamics/step_matrix.hpp"
#include "precompute/fem/rigid_motions.hpp"

namespace irdm::precompute {

LinearMidpoint::LinearMidpoint(const SoftBody& body)
    : body_(&body),
      mass3_(body.mass().replicate(1, 3).transpose().reshaped()),
      K_(body.stiffness(body.at_rest().u)),
      rigid_(rigid_motions(body.rest(), body.mass())) {
  assert(body.elasticity() == Elasticity::kLinear);
}

void LinearMidpoint::prepare(double h) {
  auto& solver = solvers_[h];
  if (solver) return;
  solver = make_sparse_solver();
  solver->factorise(step_matrix(*body_, K_, h));
}

void LinearMidpoint::step(Eigen::MatrixXd& u, Eigen::MatrixXd& v, const Eigen::MatrixXd& force,
                          double h) const {
  const double alpha = body_->rayleigh_alpha();
  // What is left of the equation when the mean velocity w is v.
  Eigen::MatrixXd residual = force - K_ * (u + (0.5 * h + body_->rayleigh_beta()) * v);
  if (alpha > 0.0) {
    const Eigen::MatrixXd momentum = mass3_.asDiagonal() * v;
    residual -=
        alpha * (momentum - mass3_.asDiagonal() * (rigid_ * (rigid_.transpose() * momentum)));
  }
  Eigen::MatrixXd w = v + solvers_.at(h)->solve(residual);
  // The matrix has alpha M for all motions; rigid ones are not damped.
  if (alpha > 0.0) {
    w += (0.5 * h - 1.0 / (2.0 / h + alpha)) * (rigid_ * (rigid_.transpose() * residual));
  }
  u += h * w;
  v = 2.0 * w - v;
}

}  // namespace irdm::precompute
