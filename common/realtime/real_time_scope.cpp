#include "common/realtime/real_time_scope.hpp"

#include <pthread.h>
#include <sys/mman.h>

#include <array>
#include <cstddef>

namespace irdm {
namespace {

constexpr std::size_t kStackBytes = std::size_t{256} << 10;  // a step takes less than 64 KiB
constexpr std::size_t kPage = 4096;

[[gnu::noinline]] void prepare_stack(bool lock) noexcept {
  std::array<char, kStackBytes> stack;
  volatile char* const bytes = stack.data();
  for (std::size_t i = 0; i < kStackBytes; i += kPage) bytes[i] = 0;
  if (lock) ::mlock(stack.data(), kStackBytes);  // as far as it is permitted, which is reported
}

}  // namespace

RealTimeScope::RealTimeScope(const char* name, RealTimeScheduling wanted) noexcept {
  ::pthread_setname_np(::pthread_self(), name);
#ifdef IRDM_SANITIZED
  const bool lock = false;
#else
  const bool lock = wanted != RealTimeScheduling::kIgnore;
#endif
  static_cast<void>(wanted);
  prepare_stack(lock);
}

}  // namespace irdm
