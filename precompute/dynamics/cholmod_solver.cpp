// Compiled with IRDM_WITH_CHOLMOD only. CHOLMOD's supernodal part is GPL-2+: a program built with
// it may be passed on under the GPL only.
#include <suitesparse/cholmod.h>

#include <algorithm>

#include "common/error.hpp"
#include "precompute/dynamics/sparse_solver.hpp"

namespace irdm::precompute {
namespace {

// CHOLMOD's settings and work space, one a thread.
struct Common {
  cholmod_common value;
  Common() {
    cholmod_start(&value);
    value.print = 0;
    value.supernodal = CHOLMOD_SUPERNODAL;
  }
  Common(const Common&) = delete;
  Common& operator=(const Common&) = delete;
  ~Common() { cholmod_finish(&value); }
};

cholmod_common* common() {
  thread_local Common common;
  return &common.value;
}

// CHOLMOD takes no constants but does not change what it is given here.
template <typename T>
T* mutable_pointer(const T* pointer) {
  return const_cast<T*>(pointer);
}

cholmod_sparse lower_triangle(const Eigen::SparseMatrix<double>& matrix) {
  cholmod_sparse view{};
  view.nrow = static_cast<std::size_t>(matrix.rows());
  view.ncol = static_cast<std::size_t>(matrix.cols());
  view.nzmax = static_cast<std::size_t>(matrix.nonZeros());
  view.p = mutable_pointer(matrix.outerIndexPtr());
  view.i = mutable_pointer(matrix.innerIndexPtr());
  view.x = mutable_pointer(matrix.valuePtr());
  view.stype = -1;
  view.itype = CHOLMOD_INT;
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  view.sorted = 1;
  view.packed = 1;
  return view;
}

cholmod_dense columns_of(const Eigen::Ref<const Eigen::MatrixXd>& matrix) {
  cholmod_dense view{};
  view.nrow = static_cast<std::size_t>(matrix.rows());
  view.ncol = static_cast<std::size_t>(matrix.cols());
  view.d = static_cast<std::size_t>(matrix.outerStride());
  view.nzmax = view.d * view.ncol;
  view.x = mutable_pointer(matrix.data());
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  return view;
}

class CholmodSolver final : public SparseSolver {
 public:
  CholmodSolver() = default;
  CholmodSolver(const CholmodSolver&) = delete;
  CholmodSolver& operator=(const CholmodSolver&) = delete;
  ~CholmodSolver() override { cholmod_free_factor(&factor_, common()); }

  void factorise(const Eigen::SparseMatrix<double>& matrix) override {
    cholmod_sparse view = lower_triangle(matrix);
    if (factor_ == nullptr) factor_ = cholmod_analyze(&view, common());
    const bool good = factor_ != nullptr && cholmod_factorize(&view, factor_, common()) != 0 &&
                      common()->status == CHOLMOD_OK && factor_->minor == factor_->n;
    if (!good) {
      throw Error("time stepping", "the matrix of a step is not positive definite",
                  "check the mesh for extremely distorted elements, or use smaller steps");
    }
  }

  Eigen::MatrixXd solve(const Eigen::Ref<const Eigen::MatrixXd>& right) const override {
    cholmod_dense view = columns_of(right);
    cholmod_dense* solved = cholmod_solve(CHOLMOD_A, factor_, &view, common());
    if (solved == nullptr) throw std::bad_alloc();
    Eigen::MatrixXd result = Eigen::Map<const Eigen::MatrixXd>(
        static_cast<const double*>(solved->x), right.rows(), right.cols());
    cholmod_free_dense(&solved, common());
    return result;
  }

 private:
  cholmod_factor* factor_ = nullptr;
};

}  // namespace

std::unique_ptr<SparseSolver> make_sparse_solver() {
  return std::make_unique<CholmodSolver>();
}

const char* sparse_solver_name() {
  return "CHOLMOD";
}

}  // namespace irdm::precompute
