#include "precompute/modal/elastic_statics.hpp"

#include <algorithm>
#include <cmath>

#include "common/error.hpp"
#include "common/response/modal_response.hpp"
#include "precompute/fem/assembly.hpp"
#include "precompute/fem/rigid_motions.hpp"

namespace irdm::precompute {

void add_body_loads(const ElasticModes& modes, const Model& model, ModalResponse& response) {
  if (model.body.support == Support::kFloating) {
    response.centrifugal =
        modes.shapes.transpose() * centrifugal_loads(model.mesh.nodes, model.mesh.node_mass);
  } else {
    response.gravity = modes.shapes.transpose() * uniform_loads(model.mesh.node_mass);
  }
}

void add_gravity_rest(const ElasticStatics& statics, const Model& model, ModalResponse& response) {
  if (response.gravity.rows() == 0) return;
  const Eigen::MatrixXd all = statics.displacement(uniform_loads(model.mesh.node_mass));
  const auto& shapes = std::get<RowMatrix<double>>(response.shapes);
  response.gravity_rest = -shapes *
                          response.angular_frequency.cwiseAbs2().cwiseInverse().asDiagonal() *
                          response.gravity;
  for (int i = 0; i < model.mesh.surface_node_count(); ++i) {
    const int node = model.mesh.surface_nodes[static_cast<std::size_t>(i)];
    response.gravity_rest.middleRows<3>(3 * i) += all.middleRows<3>(3 * node);
  }
}

namespace {

// R[s](a, a): (3n, T).
RowMatrix<double> driving_points(const ModalResponse& response, double dt, int steps) {
  const RowMatrix<double> squares = std::get<RowMatrix<double>>(response.shapes).array().square();
  return squares * held_responses(response, dt, steps).transpose();
}

// The peak is looked for in these steps, so that memory is bounded. [steps]
constexpr int kPeakSteps = 4096;

// Bound of |q| of one mode at and after the end of step T-1.
double later_bound(const HeldForceOscillator& o, double omega, int steps) {
  Eigen::Matrix2d power;  // of the step's transition, squared again and again
  power << o.a11, o.a12, o.a21, o.a22;
  Eigen::Vector2d state(o.b1, o.b2);
  for (int left = steps - 1; left > 0; left /= 2) {
    if (left % 2 == 1) state = (power * state).eval();
    power = (power * power).eval();
  }
  return std::hypot(state.x(), state.y() / omega);
}

}  // namespace

double decay_left(const ModalResponse& response, double dt, int steps) {
  const auto& shapes = std::get<RowMatrix<double>>(response.shapes);
  const RowMatrix<double> squares = shapes.array().square();
  Eigen::VectorXd bound(response.mode_count());
  for (Eigen::Index i = 0; i < bound.size(); ++i) {
    const double omega = response.angular_frequency(i);
    bound(i) = later_bound(held_force_oscillator(omega, response.decay_rate(i), dt), omega, steps);
  }
  const int watched = std::min(steps, kPeakSteps);
  const Eigen::VectorXd peak =
      driving_points(response, dt, watched).cwiseAbs().rowwise().maxCoeff();
  const Eigen::VectorXd left = squares * bound;
  return (peak.array() > 0.0).select(left.cwiseQuotient(peak), 0.0).maxCoeff();  // 0: clamped
}

ElasticStatics::ElasticStatics(SparseMatrix stiffness, const Points& nodes,
                               const Eigen::VectorXd& mass, const std::vector<int>& clamped,
                               std::unique_ptr<SparseSolver> solver)
    : root_mass_(mass.replicate(1, 3).transpose().reshaped().cwiseSqrt()),
      largest_square_((stiffness.diagonal().array() / root_mass_.array().square()).maxCoeff()),
      solver_(std::move(solver)) {
  for (const int node : clamped) {
    for (int axis = 0; axis < 3; ++axis) clamped_.push_back(3 * node + axis);
  }
  if (clamped.empty()) {
    rigid_ = root_mass_.asDiagonal() * rigid_motions(nodes, mass);
    hold_determinately(stiffness, nodes);
  } else {
    clamp(stiffness);
  }
  elastic_modes_ =
      degrees_of_freedom() - rigid_.cols() - static_cast<Eigen::Index>(clamped_.size());
  try {
    solver_->factorise(stiffness);
  } catch (const Error&) {
    throw LostModes("its stiffness is not positive definite where the body is held");
  }
}

// Rows and columns of clamped degrees of freedom become those of a unit matrix, scaled.
void ElasticStatics::clamp(SparseMatrix& stiffness) const {
  Eigen::VectorXd moves = Eigen::VectorXd::Ones(stiffness.rows());
  moves(clamped_).setZero();
  const Eigen::VectorXd diagonal = stiffness.diagonal();
  stiffness = moves.asDiagonal() * stiffness * moves.asDiagonal();
  for (const int dof : clamped_) stiffness.coeffRef(dof, dof) = diagonal(dof);
}

void ElasticStatics::keep_elastic(Eigen::Ref<Eigen::MatrixXd> x) const {
  if (rigid_.cols() > 0) {
    const Eigen::MatrixXd part = rigid_.transpose() * x;
    x.noalias() -= rigid_ * part;
  }
  for (const int dof : clamped_) x.row(dof).setZero();
}

Eigen::MatrixXd ElasticStatics::flexibility(const Eigen::Ref<const Eigen::MatrixXd>& x) const {
  Eigen::MatrixXd load = x;
  keep_elastic(load);
  load = root_mass_.asDiagonal() * load;
  Eigen::MatrixXd y = root_mass_.asDiagonal() * solver_->solve(load);
  keep_elastic(y);
  return y;
}

Eigen::MatrixXd ElasticStatics::displacement(const Eigen::Ref<const Eigen::MatrixXd>& force) const {
  const Eigen::VectorXd inverse_root = root_mass_.cwiseInverse();
  return inverse_root.asDiagonal() * flexibility(inverse_root.asDiagonal() * force);
}

}  // namespace irdm::precompute
