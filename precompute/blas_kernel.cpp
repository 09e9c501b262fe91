#include "precompute/blas_kernel.hpp"

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

}  // namespace irdm::precompute
