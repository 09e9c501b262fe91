#pragma once

#include <cstdint>
#include <string>

#include "tests/support/allocation_guard.hpp"

namespace irdm::test {

/// Counts what a real-time step must not do, in the calling thread from its construction on: takes
/// or gives back heap memory, locks a mutex, throws, opens, reads or writes (a line of a log ends
/// in a write, and locks). A program that links this counts them on the way to the library. Blind
/// under sanitizers: ask AllocationGuard::active().
class RealTimeGuard {
 public:
  RealTimeGuard() noexcept;
  /// What was done, in words; empty: nothing.
  std::string violations() const;

 private:
  AllocationGuard allocations_;
  std::uint64_t frees_;
  std::uint64_t locks_;
  std::uint64_t throws_;
  std::uint64_t files_;
};

}  // namespace irdm::test
