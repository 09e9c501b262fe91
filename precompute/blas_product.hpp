#pragma once

#include "common/model/model.hpp"

/// Products of large matrices by the BLAS. Results are made as large as they must be.
namespace irdm::precompute {

enum class Of { kItself, kTransposed };

/// C = A B, each of A and B itself or transposed; or added to C, which has its size then. Of a
/// wider B that is transposed the first columns count, as many as A has.
void product(const RowMatrix<float>& A, Of a, const RowMatrix<float>& B, Of b, RowMatrix<float>& C,
             bool add = false);
void product(const RowMatrix<double>& A, Of a, const RowMatrix<double>& B, Of b,
             RowMatrix<double>& C, bool add = false);

/// C = A B^T: the TransposedProduct of this program.
void transposed_blas_product(const RowMatrix<double>& A, const RowMatrix<double>& B,
                             RowMatrix<double>& C);

}  // namespace irdm::precompute
