#include "tests/support/allocation_guard.hpp"

#include <cerrno>
#include <cstddef>

namespace {
thread_local std::uint64_t allocations = 0;
}

#ifndef IRDM_SANITIZED
// The names that glibc keeps for whoever puts something in front of its malloc.
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);

void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  ++allocations;
  return __libc_calloc(count, size);
}
void* realloc(void* old, std::size_t size) {
  ++allocations;
  return __libc_realloc(old, size);
}
void* memalign(std::size_t alignment, std::size_t size) {
  ++allocations;
  return __libc_memalign(alignment, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  return memalign(alignment, size);
}
int posix_memalign(void** result, std::size_t alignment, std::size_t size) {
  *result = memalign(alignment, size);
  return *result == nullptr ? ENOMEM : 0;
}
}
#endif

namespace irdm::test {

AllocationGuard::AllocationGuard() noexcept : before_(allocations) {}

std::uint64_t AllocationGuard::count() const noexcept {
  return allocations - before_;
}

bool AllocationGuard::active() noexcept {
#ifdef IRDM_SANITIZED
  return false;
#else
  return true;
#endif
}

}  // namespace irdm::test
