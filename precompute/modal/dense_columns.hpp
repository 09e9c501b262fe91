#pragma once

#include <vector>

#include "precompute/columns/column_source.hpp"

namespace irdm::precompute {

/// R out of its modal form by matrix products over several columns and steps at once: a column
/// holds the displacement of every surface degree of freedom at every step after a force on one of
/// them. Scalar is float or double and rules both storage and arithmetic.
///
/// Most modes die away within a few steps. Those at the end of the list (the fastest) that have
/// become smaller than rounding, all together at most an eighth of Scalar's epsilon of what the
/// modes may add up to at that step, are left out of the products from then on.
template <typename Scalar>
class DenseColumns final : public ColumnSource {
 public:
  /// @param response with shapes in double precision
  DenseColumns(const ModalResponse& response, double dt, int steps);

  int columns() const override { return static_cast<int>(shapes_.rows()); }
  int block_size() const override { return block_size_; }
  Columns block(int k) const override;
  bool has_centrifugal() const override { return centrifugal_.rows() > 0; }
  Columns centrifugal() const override;
  bool has_gravity() const override { return gravity_.rows() > 0; }
  Columns gravity() const override;

  /// R[s](a, b) for all s and a: shape (T, 3n).
  RowMatrix<Scalar> column(int b) const;
  /// Modes that take part in step s.
  int modes_at(int s) const;

 private:
  RowMatrix<Scalar> weighted_columns(const RowMatrix<Scalar>& loads) const;

  RowMatrix<Scalar> shapes_;       // Phi (3n, r)
  RowMatrix<Scalar> responses_;    // h (T, r)
  RowMatrix<Scalar> centrifugal_;  // g^T (6, r), or no rows
  RowMatrix<Scalar> gravity_;      // g^T (3, r), or no rows
  int block_size_;
  std::vector<int> modes_;  // of each group of steps
};

extern template class DenseColumns<float>;
extern template class DenseColumns<double>;

}  // namespace irdm::precompute
