#include "replay/reference/broyden_solver.hpp"

#include "common/dense_algebra.hpp"

namespace irdm::replay {

void BroydenSolver::differentiate(const Function& function, const Eigen::VectorXd& x,
                                  const Eigen::VectorXd& value, double difference) {
  jacobian_.resize(value.size(), x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    Eigen::VectorXd beside = x;
    beside(i) += difference;
    jacobian_.col(i) = (function(beside) - value) / difference;
  }
}

bool BroydenSolver::solve(const Function& function, Eigen::VectorXd& x, double tolerance,
                          double difference) {
  Eigen::VectorXd value = function(x);
  if (jacobian_.cols() != x.size()) {
    differentiate(function, x, value, difference);
    value = function(x);
  }
  for (int i = 0; i < kMost; ++i) {
    if (value.cwiseAbs().maxCoeff() <= tolerance) return true;
    const Eigen::VectorXd way = -solve_square(jacobian_, value);
    x += way;
    const Eigen::VectorXd next = function(x);
    // value + J way is zero: what is left of it is what J lacks along the way.
    jacobian_ += next * way.transpose() / way.squaredNorm();
    value = next;
  }
  return false;
}

}  // namespace irdm::replay
