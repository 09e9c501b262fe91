#pragma once

#include "common/model/model.hpp"
#include "precompute/compress/tail_space.hpp"

namespace irdm::precompute {

/// Shapes that all matrices of a core share: M_k is about B diag(h_k) B^T.
struct JointShapes {
  RowMatrix<double> shapes;     ///< B (r, r), columns of length 1
  RowMatrix<double> responses;  ///< h (K, r)
  double error = 1.0;           ///< share of the matrices' norm that is left
};

/// First guess by a second-order recursion: displacements y follow y[l+1] = A y[l] - D y[l-1]
/// with A and D of the same eigenvectors, which are the shapes (dynamic mode decomposition); then
/// the symmetric canonical polyadic decomposition is improved by alternating least squares: h from
/// B, B from h and B. The same core gives the same shapes.
/// @param target error at which to stop
JointShapes joint_shapes(const Core& core, double target, const Console& console);

}  // namespace irdm::precompute
