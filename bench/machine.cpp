#include "bench/machine.hpp"

#include <omp.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__)
#define IRDM_CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define IRDM_CLONES
#endif

namespace irdm::bench {
namespace {

// First line of /proc/cpuinfo that begins so, after the colon.
std::string cpu_line(const std::string& begin) {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.rfind(begin, 0) == 0 && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

std::string instruction_sets() {
  std::istringstream flags(cpu_line("flags"));
  std::string sets;
  for (std::string flag; flags >> flag;) {
    for (const char* wanted : {"sse4_2", "avx", "avx2", "fma", "avx512f", "avx512bw", "avx512vl",
                               "avx512_fp16", "asimd", "sve"}) {
      if (flag == wanted) sets += (sets.empty() ? "\"" : ", \"") + flag + "\"";
    }
  }
  return sets;
}

// Bits of all numbers, which nobody can guess.
IRDM_CLONES std::uint64_t fold(const std::uint64_t* a, std::size_t n) {
  constexpr std::size_t kLanes = 32;
  std::uint64_t lanes[kLanes] = {};
  std::size_t i = 0;
  for (; i + kLanes <= n; i += kLanes) {
    for (std::size_t l = 0; l < kLanes; ++l) lanes[l] += a[i + l];
  }
  std::uint64_t sum = 0;
  for (const std::uint64_t lane : lanes) sum += lane;
  for (; i < n; ++i) sum += a[i];
  return sum;
}

IRDM_CLONES void triad_of(double* to, const double* x, const double* y, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) to[i] = x[i] + 0.5 * y[i];
}

// Calls work(begin, end) on each thread's share of n.
template <typename Work>
void share_out(std::size_t n, const Work& work) {
#pragma omp parallel
  {
    const auto threads = static_cast<std::size_t>(omp_get_num_threads());
    const auto i = static_cast<std::size_t>(omp_get_thread_num());
    work(n * i / threads, n * (i + 1) / threads);
  }
}

}  // namespace

std::string machine_json() {
  std::ostringstream text;
  text << "{\"cpu\": \"" << cpu_line("model name") << "\", \"family\": \"" << cpu_line("cpu family")
       << "\", \"model\": \"" << cpu_line("model\t")
       << "\", \"cores\": " << ::sysconf(_SC_NPROCESSORS_ONLN) << ", \"memory [GB]\": "
       << static_cast<double>(::sysconf(_SC_PHYS_PAGES)) *
              static_cast<double>(::sysconf(_SC_PAGESIZE)) / 1e9
       << ", \"L2 [kB]\": " << ::sysconf(_SC_LEVEL2_CACHE_SIZE) / 1024
       << ", \"L3 [kB]\": " << ::sysconf(_SC_LEVEL3_CACHE_SIZE) / 1024
       << ", \"instruction sets\": [" << instruction_sets() << "], \"compiler\": \"" << __VERSION__
       << "\"}";
  return text.str();
}

Memory::Memory(std::size_t bytes)
    : a_(bytes / sizeof(std::uint64_t), 1), b_(bytes / sizeof(double), 1.0) {}

Elapsed Memory::read() {
  return elapsed([&] {
    std::uint64_t sum = 0;
#pragma omp parallel reduction(+ : sum)
    {
      const auto threads = static_cast<std::size_t>(omp_get_num_threads());
      const auto i = static_cast<std::size_t>(omp_get_thread_num());
      const std::size_t begin = a_.size() * i / threads;
      sum += fold(a_.data() + begin, a_.size() * (i + 1) / threads - begin);
    }
    keep_ += sum;
  });
}

double Memory::triad() {
  // Three parts of one array.
  const std::size_t n = b_.size() / 3;
  const double time = seconds([&] {
    share_out(n, [&](std::size_t begin, std::size_t end) {
      triad_of(b_.data() + begin, b_.data() + n + begin, b_.data() + 2 * n + begin, end - begin);
    });
  });
  return 3.0 * static_cast<double>(n * sizeof(double)) / time;
}

}  // namespace irdm::bench
