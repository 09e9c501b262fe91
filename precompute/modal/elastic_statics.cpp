#include "precompute/modal/elastic_statics.hpp"

#include "common/error.hpp"
#include "precompute/fem/determinate_support.hpp"
#include "precompute/fem/rigid_motions.hpp"

namespace irdm::precompute {

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
    throw Error("mesh", "its stiffness is not positive definite where the body is held",
                "check for elements that hang on a single node or edge, and for very thin parts");
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
