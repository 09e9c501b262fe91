#include "common/realtime/wakeup.hpp"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <cstdint>

#include "common/error.hpp"

namespace irdm {

Wakeup::Wakeup() : descriptor_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (descriptor_ < 0) {
    throw Error("system", "no file descriptor for an event is left", "raise the limit (ulimit -n)");
  }
}

Wakeup::~Wakeup() {
  ::close(descriptor_);
}

void Wakeup::signal() noexcept {
  const std::uint64_t one = 1;
  [[maybe_unused]] const ssize_t written = ::write(descriptor_, &one, sizeof one);
}

bool Wakeup::consume() noexcept {
  std::uint64_t count = 0;
  return ::read(descriptor_, &count, sizeof count) == sizeof count;
}

bool Wakeup::wait(int timeout_ms) noexcept {
  pollfd entry{descriptor_, POLLIN, 0};
  return ::poll(&entry, 1, timeout_ms) > 0 && consume();
}

}  // namespace irdm
