#pragma once

#include "common/model/model.hpp"

namespace irdm::precompute {

/// R column by column out of its modal form, one matrix product a column: a column holds the
/// displacement of every surface degree of freedom at every step after a force on one of them.
/// Scalar is float or double and rules both storage and arithmetic.
template <typename Scalar>
class DenseColumns {
 public:
  /// @param response with shapes in double precision
  DenseColumns(const ModalResponse& response, double dt, int steps);

  /// R[s](a, b) for all s and a: shape (T, 3n). Valid until the next call.
  const RowMatrix<Scalar>& column(int b);

 private:
  RowMatrix<Scalar> shapes_;     // Phi (3n, r)
  RowMatrix<Scalar> responses_;  // h (T, r)
  RowMatrix<Scalar> weighted_;   // h diag(Phi_b) (T, r)
  RowMatrix<Scalar> column_;
};

extern template class DenseColumns<float>;
extern template class DenseColumns<double>;

}  // namespace irdm::precompute
