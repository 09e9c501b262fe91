// What the machine gives: memory, matrix products, and a byte's way to another process and back.
// Beside these stand the figures of the other benchmarks.
#include <cblas.h>
#include <omp.h>

#include <vector>

#include "bench/echo.hpp"
#include "bench/machine.hpp"
#include "bench/report.hpp"
#include "bench/statistics.hpp"
#include "precompute/blas.hpp"

using namespace irdm;

namespace {

constexpr std::size_t kArray = std::size_t{1} << 30;  // bytes
constexpr int kRepeats = 7;
constexpr int kTrips = 5000;

void measure_memory(bench::Report& report) {
  bench::Memory memory(kArray);
  report.table("memory", {"threads", "triad [GB/s]", "read [GB/s]"});
  for (const int threads : {1, 2}) {
    omp_set_num_threads(threads);
    std::vector<double> triad;
    std::vector<double> read;
    for (int i = 0; i < kRepeats; ++i) {
      triad.push_back(memory.triad() / 1e9);
      read.push_back(memory.read_bytes() / memory.read().wall / 1e9);
    }
    report.row({double(threads), bench::percentile(triad, 0.5), bench::percentile(read, 0.5)});
  }
}

template <typename Scalar, typename Product>
double gemm_rate(int n, const Product& product) {
  const auto count = static_cast<std::size_t>(n) * static_cast<std::size_t>(n);
  const std::vector<Scalar> a(count, Scalar(0.5)), b(count, Scalar(0.25));
  std::vector<Scalar> c(count);
  std::vector<double> rates;
  for (int i = 0; i < kRepeats; ++i) {
    const double time = bench::seconds([&] { product(a.data(), b.data(), c.data()); });
    rates.push_back(2.0 * n * n * n / time / 1e9);
  }
  return bench::percentile(rates, 0.5);
}

void measure_products(bench::Report& report) {
  constexpr int kSize = 1536;
  report.table("matrix product", {"BLAS kernel", "threads", "float [GFLOP/s]", "double [GFLOP/s]"});
  for (const int threads : {1, 2}) {
    precompute::set_blas_threads(threads);
    const double single = gemm_rate<float>(kSize, [](const float* a, const float* b, float* c) {
      cblas_sgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, kSize, kSize, kSize, 1.0F, a, kSize, b,
                  kSize, 0.0F, c, kSize);
    });
    const double twice = gemm_rate<double>(kSize, [](const double* a, const double* b, double* c) {
      cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, kSize, kSize, kSize, 1.0, a, kSize, b,
                  kSize, 0.0, c, kSize);
    });
    report.row({precompute::blas_kernel(), double(threads), single, twice});
  }
}

void measure_echo(bench::Report& report) {
  bench::Echo echo(64, 64);
  std::vector<double> times;
  for (int i = 0; i < kTrips; ++i) times.push_back(1e6 * echo.round_trip());
  report.table("loopback, 64 bytes there and back",
               {"median [us]", "p90 [us]", "p99 [us]", "longest [us]"});
  report.row({bench::percentile(times, 0.5), bench::percentile(times, 0.9),
              bench::percentile(times, 0.99), bench::percentile(times, 1.0)});
}

}  // namespace

int main(int, char** argv) {
  precompute::use_fast_blas_kernel(argv);
  bench::Report report("machine");
  measure_echo(report);  // first: its child is a copy of this process
  measure_memory(report);
  measure_products(report);
}
