// How fast the deformation thread reads the responses, beside what the machine's memory gives (the
// triad a[i] = b[i] + s c[i], two reads and one write, with the same threads in the same run).

#include <omp.h>

#include <cstdio>
#include <memory>

#include "bench/statistics.hpp"
#include "server/engine/response_engine.hpp"
#include "tests/support/synthetic_model.hpp"

using namespace irdm;

namespace {

constexpr int kSteps = 500;
constexpr int kRepeats = 15;

/// Bytes a second that the triad moves, median.
double triad() {
  constexpr std::size_t kCount = 20'000'000;
  static std::vector<double> a(kCount, 0.0), b(kCount, 1.0), c(kCount, 2.0);
  std::vector<double> times;
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    times.push_back(bench::seconds([&] {
      double* to = a.data();
      const double* x = b.data();
      const double* y = c.data();
#pragma omp parallel for schedule(static)
      for (std::size_t i = 0; i < kCount; ++i) to[i] = x[i] + 0.5 * y[i];
    }));
  }
  return 3.0 * kCount * sizeof(double) / bench::percentile(times, 0.5);
}

/// Median seconds of one surface after a full history of forces on three nodes.
double surface_time(ResponseEngine& engine) {
  const std::array<NodalForce, 3> forces{NodalForce{1, Vector3(0.1, 0.2, 0.3)},
                                         {2, Vector3(0.3, 0.1, 0.2)},
                                         {3, Vector3(0.2, 0.3, 0.1)}};
  for (int k = 0; k < kSteps; ++k) engine.advance(forces);
  Points u;
  std::vector<double> times;
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    times.push_back(bench::seconds([&] { engine.displacement(u); }));
  }
  return bench::percentile(times, 0.5);
}

void print(const char* engine, int nodes, int threads, double bytes, double time, double memory) {
  std::printf("| %s | %d | %d | %.1f | %.2f | %.2f | %.2f | %.2f |\n", engine, nodes, threads,
              bytes / 1e6, 1e3 * time, bytes / time / 1e9, memory / 1e9, bytes / time / memory);
  std::fflush(stdout);
}

}  // namespace

int main() {
  std::printf(
      "| engine | surface nodes | threads | MB of R read | ms | GB/s | triad GB/s | share |\n"
      "|---|---|---|---|---|---|---|---|\n");
  for (const int threads : {1, 2}) {
    omp_set_num_threads(threads);
    const double memory = triad();
    for (const int cells : {5, 6, 8}) {
      const Model modal = test::synthetic_cube(cells, 40, kSteps);
      const auto dof = static_cast<double>(modal.degrees_of_freedom());
      const auto dense =
          make_engine(std::make_shared<const Model>(test::with_dense_response<float>(modal)));
      print("dense", modal.mesh.surface_node_count(), threads, 9.0 * dof * kSteps * sizeof(float),
            surface_time(*dense), memory);
    }
    // The paper's cube with all its modes; synthetic shapes are double precision.
    constexpr int kModes = 4050;
    const Model modal = test::synthetic_cube(12, kModes, kSteps);
    const auto engine = make_engine(std::make_shared<const Model>(modal));
    print("modal", modal.mesh.surface_node_count(), threads,
          modal.degrees_of_freedom() * double{kModes} * sizeof(double), surface_time(*engine),
          memory);
  }
}
