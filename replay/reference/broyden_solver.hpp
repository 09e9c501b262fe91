#pragma once

#include <Eigen/Dense>
#include <functional>

namespace irdm::replay {

/// Finds where a smooth function of a few numbers is zero, by Broyden's method: Newton's, with a
/// Jacobian that is found by differences once and corrected along each way that is gone (C. G.
/// Broyden, A class of methods for solving nonlinear simultaneous equations, Math. Comp. 19, 1965).
/// The Jacobian is kept from one solution to the next, for functions that change little. One
/// thread.
class BroydenSolver {
 public:
  using Function = std::function<Eigen::VectorXd(const Eigen::VectorXd&)>;

  /// Before a function that is another one, or has another number of unknowns.
  void forget() { jacobian_.resize(0, 0); }

  /// The last point that the function is called with is the one that is found.
  /// @param x in: where to begin; out: the zero
  /// @param tolerance of each component of the function
  /// @param difference for the first Jacobian, in the unit of x
  /// @returns false when it does not get there in kMost steps
  [[nodiscard]] bool solve(const Function& function, Eigen::VectorXd& x, double tolerance,
                           double difference);

  static constexpr int kMost = 40;

 private:
  void differentiate(const Function& function, const Eigen::VectorXd& x,
                     const Eigen::VectorXd& value, double difference);

  Eigen::MatrixXd jacobian_;
};

}  // namespace irdm::replay
