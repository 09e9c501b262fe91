#pragma once

#include <Eigen/Sparse>

#include "precompute/dynamics/soft_body.hpp"

namespace irdm::precompute {

/// (2/h + alpha) M + (h/2 + beta) K: what the mean velocity of a step of length h [s] is solved
/// with. alpha counts for all motions here; that rigid ones are not damped is mended afterwards.
Eigen::SparseMatrix<double> step_matrix(const SoftBody& body,
                                        const Eigen::SparseMatrix<double>& stiffness, double h);

}  // namespace irdm::precompute
