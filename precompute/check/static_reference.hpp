#pragma once

#include <memory>

#include "common/model/model.hpp"
#include "precompute/dynamics/sparse_solver.hpp"
#include "precompute/fem/assembly.hpp"

namespace irdm::precompute {

/// G = 1/M - [at]x I_B^-1 [from]x: velocity of the point `at` (B) of the rigid body per impulse at
/// the point `from` [1/kg]; zero for a fixed body. A force of 1 N held during one step moves it by
/// dt^2 (s + 1/2) G until the end of step s.
Matrix3 rigid_mobility(const BodyProperties& body, const Vector3& at, const Vector3& from);

/// The free body under a force that stays: solved with finite elements that are assembled again
/// from mesh and material of the model file, with nothing in common with the response.
class StaticReference {
 public:
  /// Throws Error when the stiffness cannot be factorised.
  explicit StaticReference(const Model& model);

  /// Elastic displacement of the surface under 1 N on surface degree of freedom b, (3n) [m/N]. What
  /// accelerates the body as a whole is balanced by the nodes' inertia ("inertia relief"), and the
  /// displacement carries no momentum: sum m u = 0, sum m x times u = 0.
  Eigen::VectorXd displacement(int b) const;

  /// Surface rows of the six rigid motions (3n, 6), mass-normalised over all nodes.
  const Eigen::MatrixXd& surface_rigid() const { return surface_rigid_; }

 private:
  std::vector<int> surface_;  // degrees of freedom in the mesh
  Eigen::VectorXd mass_;      // (3N)
  Eigen::MatrixXd rigid_;     // (3N, 6)
  Eigen::MatrixXd surface_rigid_;
  std::unique_ptr<SparseSolver> solver_ = make_sparse_solver();
};

struct StaticComparison {
  double rigid;     ///< largest displacement of the rigid motion in the difference,
  double mismatch;  ///< and of the rest, as shares of the largest expected displacement
};

/// Splits what a column has beyond the reference into a rigid motion of the surface (by least
/// squares), which is momentum that the column should not carry, and the rest, which is another
/// elasticity.
StaticComparison compare_static(const Eigen::VectorXd& found, const Eigen::VectorXd& expected,
                                const Eigen::MatrixXd& surface_rigid);

}  // namespace irdm::precompute
