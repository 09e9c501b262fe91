#include "precompute/modal/lowest_modes.hpp"

#include <Spectra/SymEigsSolver.h>
#include <lapacke.h>
#include <algorithm>
#include <string>
#include <vector>

#include "common/error.hpp"
#include "precompute/blas.hpp"

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

namespace {

constexpr int kMostRestarts = 1000;
constexpr double kLanczosTolerance = 1e-10;
// Of the largest stiffness over mass; up to here omega^2 is zero. The factors keep small stiffness
// beside large, so that this is nearer to the rounding than where all modes are computed.
constexpr double kRigidShare = 1e-14;

// What Spectra asks for: M^1/2 K^+ M^1/2.
class Flexibility {
 public:
  using Scalar = double;
  explicit Flexibility(const ElasticStatics& statics) : statics_(statics) {}
  Eigen::Index rows() const { return statics_.degrees_of_freedom(); }
  Eigen::Index cols() const { return rows(); }
  void perform_op(const double* x, double* y) const {
    Eigen::Map<Eigen::VectorXd>(y, rows()) =
        statics_.flexibility(Eigen::Map<const Eigen::VectorXd>(x, rows()));
  }

 private:
  const ElasticStatics& statics_;
};

}  // namespace

void check_lowest(const Eigen::VectorXd& omega, double largest_square) {
  if (omega(0) * omega(0) > kRigidShare * largest_square) return;
  throw LostModes("there are motions without elastic energy besides the rigid ones");
}

int most_lowest_modes(const ElasticStatics& statics) {
  return static_cast<int>(std::max<Eigen::Index>(1, statics.elastic_modes() / 2));
}

ElasticModes lowest_modes(const ElasticStatics& statics, int count) {
  const SingleThreadedBlas
      single;  // the supernodes are too small to be shared: a sixth of the time
  Flexibility flexibility(statics);
  const auto basis = std::min<Eigen::Index>(2 * count + 20, statics.elastic_modes());
  Spectra::SymEigsSolver<Flexibility> solver(flexibility, count, basis);
  solver.init();
  solver.compute(Spectra::SortRule::LargestAlge, kMostRestarts, kLanczosTolerance);
  if (solver.info() != Spectra::CompInfo::Successful) {
    throw Error("eigensolver", std::to_string(count) + " modes do not converge",
                "ask for fewer modes, or check the mesh for extremely distorted elements");
  }
  ElasticModes modes{solver.eigenvalues().cwiseInverse().cwiseSqrt(), solver.eigenvectors()};
  check_lowest(modes.angular_frequency, statics.largest_square());
  statics.keep_elastic(modes.shapes);
  modes.shapes = statics.root_mass().cwiseInverse().asDiagonal() * modes.shapes;
  return modes;
}

}  // namespace irdm::precompute
