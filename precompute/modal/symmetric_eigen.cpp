#include "precompute/modal/symmetric_eigen.hpp"

#include <lapacke.h>

#include <vector>

#include "common/error.hpp"

namespace irdm::precompute {

double symmetric_eigen_bytes(Eigen::Index n) {
  return 3.0 * static_cast<double>(n) * static_cast<double>(n) * sizeof(double);
}

// The Fortran symbol, declared by lapacke.h and provided by OpenBLAS itself: LAPACKE's own wrapper
// would bring a second copy of LAPACK and scan the whole matrix for NaN.
EigenPairs symmetric_eigen(Eigen::MatrixXd matrix) {
  if (matrix.rows() > kMaxEigenSize) {
    throw Error("mesh",
                std::to_string(matrix.rows() / 3) + " nodes are too many for all modes (at most " +
                    std::to_string(kMaxEigenSize / 3) + ")",
                "use a coarser mesh");
  }
  EigenPairs pairs{Eigen::VectorXd(matrix.rows()), std::move(matrix)};
  const auto n = static_cast<lapack_int>(pairs.vectors.rows());
  const lapack_int work_length = 1 + 6 * n + 2 * n * n;
  const lapack_int integer_length = 3 + 5 * n;
  std::vector<double> work(static_cast<std::size_t>(work_length));
  std::vector<lapack_int> integers(static_cast<std::size_t>(integer_length));
  lapack_int info = 0;
  LAPACK_dsyevd("V", "L", &n, pairs.vectors.data(), &n, pairs.values.data(), work.data(),
                &work_length, integers.data(), &integer_length, &info);
  if (info != 0) {
    throw Error("eigensolver", "dsyevd reports " + std::to_string(info),
                "check the mesh for extremely distorted elements");
  }
  return pairs;
}

}  // namespace irdm::precompute
