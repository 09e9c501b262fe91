#pragma once

#include <cstdint>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace irdm {

/// While it exists, numbers below the normal ones are zero in this thread: results, and what is
/// read. Computing with them costs a hundred times as much. Costs nothing to speak of itself.
class NoDenormals {
 public:
  NoDenormals() noexcept : before_(mode()) { set_mode(before_ | kFlush); }
  NoDenormals(const NoDenormals&) = delete;
  NoDenormals& operator=(const NoDenormals&) = delete;
  ~NoDenormals() { set_mode(before_); }

 private:
#if defined(__SSE2__)
  using Mode = std::uint32_t;
  static constexpr Mode kFlush = 0x8040;  // results to zero; denormals are zeros
  static Mode mode() noexcept {
    return _mm_getcsr();
  }
  static void set_mode(Mode mode) noexcept {
    _mm_setcsr(mode);
  }
#elif defined(__aarch64__)
  using Mode = std::uint64_t;
  static constexpr Mode kFlush = Mode{1} << 24;
  static Mode mode() noexcept {
    Mode now;
    asm volatile("mrs %0, fpcr" : "=r"(now));
    return now;
  }
  static void set_mode(Mode mode) noexcept {
    asm volatile("msr fpcr, %0" : : "r"(mode));
  }
#else
  using Mode = int;
  static constexpr Mode kFlush = 0;
  static Mode mode() noexcept {
    return 0;
  }
  static void set_mode(Mode) noexcept {}
#endif
  Mode before_;
};

}  // namespace irdm
