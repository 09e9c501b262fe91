#include "tests/support/real_time_guard.hpp"

#include <dlfcn.h>
#include <fcntl.h>
#include <pthread.h>
#include <sys/types.h>
#include <unistd.h>

#include <cstdarg>
#include <cstddef>
#include <typeinfo>

namespace {
thread_local std::uint64_t frees = 0;
thread_local std::uint64_t locks = 0;
thread_local std::uint64_t throws = 0;
thread_local std::uint64_t files = 0;
}  // namespace

#ifndef IRDM_SANITIZED
namespace {

// The next one of that name behind ours.
template <typename Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

using Open = int(const char*, int, ...);

int open_by(Open* real, const char* path, int flags, mode_t mode) {
  ++files;
  return real(path, flags, mode);
}

}  // namespace

extern "C" {
void __libc_free(void*);

void free(void* memory) {
  if (memory != nullptr) ++frees;
  __libc_free(memory);
}

int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
  static auto* const real = next<int(pthread_mutex_t*)>("pthread_mutex_lock");
  ++locks;
  return real(mutex);
}

[[noreturn]] void __cxa_throw(void* thrown, std::type_info* type, void (*destroy)(void*)) {
  static auto* const real = next<void(void*, std::type_info*, void (*)(void*))>("__cxa_throw");
  ++throws;
  real(thrown, type, destroy);
  __builtin_unreachable();
}

int open(const char* path, int flags, ...) {
  static Open* const real = next<Open>("open");
  va_list more;
  va_start(more, flags);
  const mode_t mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(more, mode_t) : 0;
  va_end(more);
  return open_by(real, path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  static Open* const real = next<Open>("open64");
  va_list more;
  va_start(more, flags);
  const mode_t mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(more, mode_t) : 0;
  va_end(more);
  return open_by(real, path, flags, mode);
}

ssize_t read(int descriptor, void* bytes, std::size_t size) {
  static auto* const real = next<ssize_t(int, void*, std::size_t)>("read");
  ++files;
  return real(descriptor, bytes, size);
}

ssize_t write(int descriptor, const void* bytes, std::size_t size) {
  static auto* const real = next<ssize_t(int, const void*, std::size_t)>("write");
  ++files;
  return real(descriptor, bytes, size);
}
}
#endif

namespace irdm::test {

RealTimeGuard::RealTimeGuard() noexcept
    : frees_(frees), locks_(locks), throws_(throws), files_(files) {}

std::string RealTimeGuard::violations() const {
  // Read before the text below allocates.
  const std::uint64_t counts[] = {allocations_.count(), frees - frees_, locks - locks_,
                                  throws - throws_, files - files_};
  const char* const names[] = {"allocations", "frees", "locks", "throws", "file accesses"};
  std::string text;
  for (std::size_t i = 0; i < std::size(counts); ++i) {
    if (counts[i] > 0) text += std::to_string(counts[i]) + " " + names[i] + " ";
  }
  return text;
}

}  // namespace irdm::test
