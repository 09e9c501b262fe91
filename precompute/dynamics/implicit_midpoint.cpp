#include "precompute/dynamics/implicit_midpoint.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "common/error.hpp"
#include "precompute/dynamics/rigid_extraction.hpp"
#include "precompute/dynamics/sparse_solver.hpp"
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

namespace {

// A correction larger than this share of the one before calls for a better matrix.
constexpr double kSlow = 0.3;

}  // namespace

ImplicitMidpoint::ImplicitMidpoint(const SoftBody& body, double tolerance, int most_iterations)
    : body_(&body),
      tolerance_(tolerance),
      most_iterations_(most_iterations),
      mass3_(body.mass().replicate(1, 3).transpose().reshaped()) {}

void ImplicitMidpoint::prepare(double h) {
  auto& solver = solvers_[h];
  if (solver) return;
  solver = make_sparse_solver();
  solver->factorise(step_matrix(*body_, body_->stiffness(body_->at_rest().u), h));
}

double ImplicitMidpoint::speed(const Eigen::VectorXd& v) const {
  return std::sqrt(v.dot(mass3_.cwiseProduct(v)));
}

// A correction below this moves nodes by less than their positions are rounded by: they are where
// they should be, however slow the body is.
double ImplicitMidpoint::speed_of_rounding(const Eigen::VectorXd& u, double h) const {
  const Eigen::VectorXd x = body_->rest().reshaped<Eigen::RowMajor>() + u;
  return std::numeric_limits<double>::epsilon() * speed(x) * 2.0 / h;
}

Eigen::VectorXd ImplicitMidpoint::correction(const SparseSolver& solver, const Matrix3& Q,
                                             const BodyState& middle,
                                             const Eigen::VectorXd& residual, double h) const {
  Eigen::VectorXd turned = residual;
  turned.reshaped(3, residual.size() / 3) =
      Q.transpose() * residual.reshaped(3, residual.size() / 3);
  const Eigen::VectorXd solved = solver.solve(turned);
  Eigen::VectorXd w(residual.size());
  w.reshaped(3, residual.size() / 3) = Q * solved.reshaped(3, residual.size() / 3);
  // The matrix has alpha M for all motions; rigid ones are not damped.
  const double alpha = body_->rayleigh_alpha();
  if (alpha > 0.0) {
    w += (0.5 * h - 1.0 / (2.0 / h + alpha)) *
         body_->rigid_velocity(middle.u, residual.cwiseQuotient(mass3_));
  }
  return w;
}

void ImplicitMidpoint::step(BodyState& state, const Eigen::VectorXd& force, double h,
                            Workspace& workspace) const {
  const bool linear = body_->elasticity() == Elasticity::kLinear;
  const SparseSolver* solver = solvers_.at(h).get();
  Matrix3 Q = Matrix3::Identity();
  if (!linear) {
    const Eigen::Map<const Points> u(state.u.data(), body_->rest().rows(), 3);
    Q = extract_rigid_motion(body_->rest(), u, body_->mass(), RotationWeights::kMass).rotation;
  }
  workspace.largest_speed = std::max(workspace.largest_speed, speed(state.v));
  const double rounding = speed_of_rounding(state.u, h);
  const StepStart start = body_->start_of_step(state.u);
  BodyState middle{state.u + 0.5 * h * state.v, state.v};  // velocity: w
  double last = 0.0;
  bool own_matrix = false;
  for (int i = 0;; ++i) {
    const Eigen::VectorXd residual = body_->mean_force(start, middle.v, h) + force -
                                     (2.0 / h) * mass3_.cwiseProduct(middle.v - state.v);
    if (own_matrix) {
      if (!workspace.solver) workspace.solver = make_sparse_solver();
      workspace.solver->factorise(step_matrix(*body_, body_->stiffness(middle.u), h));
      ++workspace.factorisations;
      solver = workspace.solver.get();
      Q.setIdentity();
    }
    const Eigen::VectorXd delta = correction(*solver, Q, middle, residual, h);
    ++workspace.solutions;
    middle.v += delta;
    middle.u = state.u + 0.5 * h * middle.v;
    const double size = speed(delta);
    workspace.largest_speed = std::max(workspace.largest_speed, speed(middle.v));
    if (linear || size <= std::max(tolerance_ * workspace.largest_speed, rounding)) break;
    if (i >= most_iterations_ || !std::isfinite(size)) {
      throw Error("time stepping", "a step of " + std::to_string(h) + " s cannot be solved",
                  "use smaller steps or a smaller force");
    }
    own_matrix = own_matrix || (i > 0 && size > kSlow * last);
    last = size;
  }
  state.u += h * middle.v;
  state.v = 2.0 * middle.v - state.v;
}

}  // namespace irdm::precompute
