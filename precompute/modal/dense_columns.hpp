#pragma once

#include "precompute/columns/column_source.hpp"

namespace irdm::precompute {

/// R out of its modal form, one matrix product a block of columns: a column holds the displacement
/// of every surface degree of freedom at every step after a force on one of them.
/// Scalar is float or double and rules both storage and arithmetic.
template <typename Scalar>
class DenseColumns final : public ColumnSource {
 public:
  /// @param response with shapes in double precision
  DenseColumns(const ModalResponse& response, double dt, int steps);

  int columns() const override { return static_cast<int>(shapes_.rows()); }
  int block_size() const override { return block_size_; }
  Columns block(int k) const override;

  /// R[s](a, b) for all s and a: shape (T, 3n).
  RowMatrix<Scalar> column(int b) const;

 private:
  RowMatrix<Scalar> shapes_;     // Phi (3n, r)
  RowMatrix<Scalar> responses_;  // h (T, r)
  int block_size_;
};

extern template class DenseColumns<float>;
extern template class DenseColumns<double>;

}  // namespace irdm::precompute
