#include "common/realtime/event_fd.hpp"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <cstdint>

#include "common/error.hpp"

namespace irdm {

EventFd::EventFd() : descriptor_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (descriptor_ < 0) {
    throw Error("system", "no file descriptor for an event is left", "raise the limit (ulimit -n)");
  }
}

EventFd::~EventFd() {
  ::close(descriptor_);
}

void EventFd::signal() noexcept {
  const std::uint64_t one = 1;
  [[maybe_unused]] const ssize_t written = ::write(descriptor_, &one, sizeof one);
}

bool EventFd::consume() noexcept {
  std::uint64_t count = 0;
  return ::read(descriptor_, &count, sizeof count) == sizeof count;
}

bool EventFd::wait(int timeout_ms) noexcept {
  pollfd entry{descriptor_, POLLIN, 0};
  return ::poll(&entry, 1, timeout_ms) > 0 && consume();
}

}  // namespace irdm
