#include "bench/sparse_resident.hpp"

#include <sys/mman.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <new>

namespace {

constexpr std::size_t kHuge = std::size_t{1} << 28;
struct Region {
  void* begin = nullptr;
  std::size_t bytes = 0;
};
// Benchmarks are done with them from one thread.
std::array<Region, 64> regions;

}  // namespace

// In benchmarks very large pieces of memory are only promised: the system gives pages when they are
// written to, and does not ask whether there are enough.
void* operator new(std::size_t bytes) {
  if (bytes < kHuge) {
    if (void* memory = std::malloc(bytes == 0 ? 1 : bytes)) return memory;
    throw std::bad_alloc();
  }
  for (Region& region : regions) {
    if (region.begin != nullptr) continue;
    void* memory = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE,
                          MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (memory == MAP_FAILED) throw std::bad_alloc();
    region = {memory, bytes};
    return memory;
  }
  throw std::bad_alloc();
}

void operator delete(void* memory) noexcept {
  for (Region& region : regions) {
    if (memory == nullptr || region.begin != memory) continue;
    ::munmap(memory, region.bytes);
    region = {};
    return;
  }
  std::free(memory);
}

void operator delete(void* memory, std::size_t) noexcept {
  operator delete(memory);
}

namespace irdm::bench {

template <typename Scalar>
std::vector<Scalar> sparse_numbers(std::size_t count) {
  std::vector<Scalar> numbers;
  numbers.reserve(std::max(count, kHuge / sizeof(Scalar)));
  return numbers;
}

template <typename Scalar>
DenseResponse sparse_resident(int degrees_of_freedom, int steps, const std::vector<int>& nodes) {
  const auto dof = static_cast<std::size_t>(degrees_of_freedom);
  const auto count = static_cast<std::size_t>(steps);
  std::vector<Scalar> values = sparse_numbers<Scalar>(dof * dof * count);
  std::vector<Scalar> self(count);
  std::vector<Scalar> other(count);
  for (std::size_t s = 0; s < count; ++s) {
    const double left = std::exp(-0.01 * static_cast<double>(s));
    self[s] = static_cast<Scalar>(1e-3 * left);
    other[s] = static_cast<Scalar>(1e-6 * left);
  }
  for (const int node : nodes) {
    for (std::size_t b = 3 * static_cast<std::size_t>(node);
         b < 3 * static_cast<std::size_t>(node) + 3; ++b) {
      for (std::size_t a = 0; a < dof; ++a) {
        const std::vector<Scalar>& record = a == b ? self : other;
        std::copy(record.begin(), record.end(), values.data() + (b * dof + a) * count);
      }
    }
  }
  return {degrees_of_freedom, steps, std::move(values)};
}

template std::vector<float> sparse_numbers(std::size_t);
template DenseResponse sparse_resident<float>(int, int, const std::vector<int>&);

}  // namespace irdm::bench
