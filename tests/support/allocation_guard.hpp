#pragma once

#include <cstdint>

namespace irdm::test {

/// Why a test of allocations is left out where AllocationGuard is not active().
inline constexpr const char* kNotCounted = "a sanitizer brings a malloc that is not counted";

/// Counts the heap allocations of the calling thread from its construction on, by any route:
/// operator new ends in malloc, and a program that links this counts malloc and its siblings. Blind
/// under sanitizers, which bring a malloc of their own: ask active() before a check that wants
/// some.
class AllocationGuard {
 public:
  AllocationGuard() noexcept;
  std::uint64_t count() const noexcept;
  static bool active() noexcept;

 private:
  std::uint64_t before_;
};

}  // namespace irdm::test
