#include "precompute/blas.hpp"
#include "tests/support/catch.hpp"

using namespace irdm::precompute;

TEST_CASE("a slow BLAS kernel is replaced by the best one the processor has") {
  CHECK(better_blas_kernel("Prescott", {.avx2_fma = true, .avx512 = true}) == "SKYLAKEX");
  CHECK(better_blas_kernel("Nehalem", {.avx2_fma = true}) == "HASWELL");
  CHECK(better_blas_kernel("SandyBridge", {.avx2_fma = true}) == "HASWELL");
  CHECK_FALSE(better_blas_kernel("Prescott", {}));
}

TEST_CASE("a modern BLAS kernel is left alone") {
  for (const char* kernel : {"Haswell", "Zen", "SkylakeX", "Cooperlake", "neoversen1"}) {
    CHECK_FALSE(better_blas_kernel(kernel, {.avx2_fma = true, .avx512 = true}));
  }
}

TEST_CASE("the kernel in use has a name") {
  CHECK_FALSE(blas_kernel().empty());
}
