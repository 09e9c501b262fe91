#include "precompute/blas.hpp"

#include <cblas.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>

namespace irdm::precompute {
namespace {

constexpr const char* kVariable = "OPENBLAS_CORETYPE";

// x86 kernels without AVX2 (OpenBLAS driver/others/dynamic.c), in lower case.
constexpr std::array<const char*, 17> kSlowKernels{
    {"unknown", "katmai", "coppermine", "northwood", "prescott", "banias", "atom", "core2",
     "penryn", "dunnington", "nehalem", "athlon", "opteron", "opteron_sse3", "barcelona", "bobcat",
     "sandybridge"}};

}  // namespace

CpuFeatures cpu_features() {
  CpuFeatures cpu;
#if defined(__x86_64__)
  __builtin_cpu_init();
  cpu.avx2_fma = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  cpu.avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
               __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl") &&
               __builtin_cpu_supports("avx512cd");
#endif
  return cpu;
}

std::optional<std::string> better_blas_kernel(const std::string& kernel, const CpuFeatures& cpu) {
  std::string name = kernel;
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const bool slow = std::find(kSlowKernels.begin(), kSlowKernels.end(), name) != kSlowKernels.end();
  if (!slow) return std::nullopt;
  if (cpu.avx512) return "SKYLAKEX";
  if (cpu.avx2_fma) return "HASWELL";
  return std::nullopt;
}

std::string blas_kernel() {
  return openblas_get_corename();
}

void use_fast_blas_kernel(char** argv) {
  if (std::getenv(kVariable) != nullptr) return;
  const auto better = better_blas_kernel(blas_kernel(), cpu_features());
  if (!better || ::setenv(kVariable, better->c_str(), 1) != 0) return;
  ::execv("/proc/self/exe", argv);  // returns only on failure: go on with the slow kernel
}

void set_blas_threads(int threads) {
  if (threads > 0) openblas_set_num_threads(threads);
}

SingleThreadedBlas::SingleThreadedBlas() : before_(openblas_get_num_threads()) {
  openblas_set_num_threads(1);
}

SingleThreadedBlas::~SingleThreadedBlas() {
  openblas_set_num_threads(before_);
}

namespace {

template <typename Scalar>
int leading(const RowMatrix<Scalar>& matrix) {
  return static_cast<int>(std::max<Eigen::Index>(1, matrix.cols()));
}

template <typename Scalar, typename Gemm>
void multiply(const RowMatrix<Scalar>& A, Of a, const RowMatrix<Scalar>& B, Of b,
              RowMatrix<Scalar>& C, bool add, const Gemm& gemm) {
  const bool a_turned = a == Of::kTransposed;
  const bool b_turned = b == Of::kTransposed;
  const Eigen::Index rows = a_turned ? A.cols() : A.rows();
  const Eigen::Index inner = a_turned ? A.rows() : A.cols();
  const Eigen::Index columns = b_turned ? B.rows() : B.cols();
  if (!add) C.resize(rows, columns);
  if (C.size() == 0) return;
  gemm(CblasRowMajor, a_turned ? CblasTrans : CblasNoTrans, b_turned ? CblasTrans : CblasNoTrans,
       static_cast<int>(rows), static_cast<int>(columns), static_cast<int>(inner), Scalar(1),
       A.data(), leading(A), B.data(), leading(B), add ? Scalar(1) : Scalar(0), C.data(),
       leading(C));
}

}  // namespace

void product(const RowMatrix<float>& A, Of a, const RowMatrix<float>& B, Of b, RowMatrix<float>& C,
             bool add) {
  multiply(A, a, B, b, C, add, cblas_sgemm);
}

void product(const RowMatrix<double>& A, Of a, const RowMatrix<double>& B, Of b,
             RowMatrix<double>& C, bool add) {
  multiply(A, a, B, b, C, add, cblas_dgemm);
}

void transposed_blas_product(const RowMatrix<double>& A, const RowMatrix<double>& B,
                             RowMatrix<double>& C) {
  product(A, Of::kItself, B, Of::kTransposed, C);
}

}  // namespace irdm::precompute
