#pragma once

#include <algorithm>
#include <chrono>
#include <ctime>
#include <vector>

namespace irdm::bench {

/// The value that a share `fraction` of the samples does not exceed.
inline double percentile(std::vector<double> samples, double fraction) {
  const auto at = static_cast<std::ptrdiff_t>(fraction * static_cast<double>(samples.size() - 1));
  std::nth_element(samples.begin(), samples.begin() + at, samples.end());
  return samples[static_cast<std::size_t>(at)];
}

/// Seconds that `work` takes.
template <typename Work>
double seconds(const Work& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// What work took: on the clock, and of all processors together.
struct Elapsed {
  double wall = 0.0;  ///< [s]
  double cpu = 0.0;   ///< [s]
  Elapsed& operator+=(const Elapsed& other) {
    wall += other.wall;
    cpu += other.cpu;
    return *this;
  }
};

template <typename Work>
Elapsed elapsed(const Work& work) {
  const auto cpu = [] {
    std::timespec now{};
    ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
  };
  const double before = cpu();
  const double wall = seconds(work);
  return {wall, cpu() - before};
}

}  // namespace irdm::bench
