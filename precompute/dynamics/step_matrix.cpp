#include "precompute/dynamics/step_matrix.hpp"

namespace irdm::precompute {

Eigen::SparseMatrix<double> step_matrix(const SoftBody& body,
                                        const Eigen::SparseMatrix<double>& stiffness, double h) {
  Eigen::SparseMatrix<double> sum = (0.5 * h + body.rayleigh_beta()) * stiffness;
  const double factor = 2.0 / h + body.rayleigh_alpha();
  for (Eigen::Index i = 0; i < stiffness.rows(); ++i) {
    sum.coeffRef(i, i) += factor * body.mass()(i / 3);
  }
  return sum;
}

}  // namespace irdm::precompute
