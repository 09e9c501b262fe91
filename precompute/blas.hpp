#pragma once

#include <optional>
#include <string>

#include "common/model/model.hpp"

namespace irdm::precompute {

/// What the processor can do, as far as BLAS kernels differ by it.
struct CpuFeatures {
  bool avx2_fma = false;
  bool avx512 = false;  ///< F, DQ, BW, VL and CD: what OpenBLAS's SkylakeX kernels use
};

/// The features of this machine.
CpuFeatures cpu_features();

/// OpenBLAS 0.3.21 does not know processors newer than itself and falls back to SSE kernels, three
/// to four times slower. Returns the value of OPENBLAS_CORETYPE that mends it, nothing when the
/// kernel in use is a modern one already or the processor has none better.
/// @param kernel name of the kernel in use, as openblas_get_corename() gives it
std::optional<std::string> better_blas_kernel(const std::string& kernel, const CpuFeatures& cpu);

/// Name of the kernel that OpenBLAS uses in this process.
std::string blas_kernel();

/// Starts this program anew with a better kernel when OpenBLAS picked a slow one and nobody chose
/// by OPENBLAS_CORETYPE. OpenBLAS looks at that only when it is loaded, hence the new start; call
/// first in main. Returns when there is nothing to do.
void use_fast_blas_kernel(char** argv);

/// Number of threads of the BLAS; 0 leaves OpenBLAS's choice, all cores.
void set_blas_threads(int threads);

/// While it lives the BLAS uses one thread: for code that calls it from several threads of its own.
class SingleThreadedBlas {
 public:
  SingleThreadedBlas();
  SingleThreadedBlas(const SingleThreadedBlas&) = delete;
  SingleThreadedBlas& operator=(const SingleThreadedBlas&) = delete;
  ~SingleThreadedBlas();

 private:
  int before_;
};

// Products of large matrices. Results are made as large as they must be.

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
