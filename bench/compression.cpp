// How far the forces of another response are from those of dense R, over a suite of 50
// interactions of one second each, through the force step itself:
//
//     bench_compression DENSE.h5 OTHER.h5 [compressed|modal]
//
// One line an interaction, then the worst, the median and what a finger can tell (10 % of force),
// and how long a step takes with either.
// A step in which friction gives way a step earlier or later counts as any other ("above 1 %").

#include <cstdio>
#include <cstring>
#include <iostream>

#include "bench/statistics.hpp"
#include "common/error.hpp"
#include "common/model/model_file.hpp"
#include "common/realtime/clock.hpp"
#include "tests/support/interaction_suite.hpp"

using namespace irdm;

namespace {

// Mean time of a step, what comes before the first one left out [us].
double step_time(const test::Interaction& what, const std::shared_ptr<const Model>& model) {
  const auto run = [&](double seconds) {
    const std::int64_t begin = monotonic_ns();
    const std::size_t steps = test::run_interaction(what, model, seconds).size();
    return std::pair(monotonic_ns() - begin, steps);
  };
  const auto [few_ns, few] = run(0.25);
  const auto [all_ns, all] = run(1.25);
  return 1e-3 * static_cast<double>(all_ns - few_ns) / static_cast<double>(all - few);
}

void compare_step_times(const std::shared_ptr<const Model>& dense,
                        const std::shared_ptr<const Model>& other) {
  std::vector<double> dense_us, other_us;
  for (int number = 0; number < 10; ++number) {
    dense_us.push_back(step_time(test::interaction(number), dense));
    other_us.push_back(step_time(test::interaction(number), other));
  }
  std::printf("mean time of a step, median of ten interactions: %.1f us dense, %.1f us the other\n",
              bench::percentile(dense_us, 0.5), bench::percentile(other_us, 0.5));
}

void compare_all(const std::shared_ptr<const Model>& dense,
                 const std::shared_ptr<const Model>& other) {
  std::vector<double> largest, rms;
  std::size_t steps = 0;
  int above = 0;
  std::printf("%-4s %-6s %10s %12s %10s %16s\n", "", "", "peak, N", "largest, %", "rms, %",
              "steps above 1 %");
  for (int number = 0; number < test::kInteractions; ++number) {
    const test::Interaction what = test::interaction(number);
    const test::ForceTrace expected = test::run_interaction(what, dense);
    const auto difference = test::compare(expected, test::run_interaction(what, other));
    std::printf("%-4d %-6s %10.3f %12.4f %10.4f %16d\n", number, what.kind.c_str(), difference.peak,
                100.0 * difference.largest, 100.0 * difference.rms, difference.above);
    steps += expected.size();
    above += difference.above;
    largest.push_back(100.0 * difference.largest);
    rms.push_back(100.0 * difference.rms);
  }
  const auto show = [](const char* name, const std::vector<double>& values) {
    std::printf("%s: median %.4f %%, p90 %.4f %%, worst %.4f %%, %d of %d above 1 %%\n", name,
                bench::percentile(values, 0.5), bench::percentile(values, 0.9),
                bench::percentile(values, 1.0),
                static_cast<int>(std::count_if(values.begin(), values.end(),
                                               [](double value) { return value > 1.0; })),
                static_cast<int>(values.size()));
  };
  show("largest difference of force, share of its peak", largest);
  show("rms difference of force, share of its rms", rms);
  std::printf("steps that differ by more than 1 %% of the peak: %d of %zu\n", above, steps);
  std::printf("worst in units of what a finger can tell (10 %% of force): %.3f\n",
              bench::percentile(largest, 1.0) / 10.0);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: bench_compression DENSE.h5 OTHER.h5 [compressed|modal]\n");
    return 2;
  }
  try {
    const bool modal = argc > 3 && std::strcmp(argv[3], "modal") == 0;
    const auto dense = std::make_shared<const Model>(read_model(argv[1], ResponseKind::kDense));
    const auto other = std::make_shared<const Model>(
        read_model(argv[2], modal ? ResponseKind::kModal : ResponseKind::kCompressed));
    compare_all(dense, other);
    compare_step_times(dense, other);
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
