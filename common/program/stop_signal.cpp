#include "common/program/stop_signal.hpp"

#include <poll.h>
#include <sys/signalfd.h>
#include <unistd.h>
#include <cerrno>
#include <csignal>

#include "common/error.hpp"

namespace irdm {

StopSignal::StopSignal() {
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);  // what does not fit is an error of the write
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  // A terminal that closes; nohup's children ignore it.
  struct sigaction hangup {};
  const bool ignored = sigaction(SIGHUP, nullptr, &hangup) == 0 && hangup.sa_handler == SIG_IGN;
  if (!ignored) sigaddset(&signals, SIGHUP);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  descriptor_ = signalfd(-1, &signals, SFD_CLOEXEC | SFD_NONBLOCK);
  if (descriptor_ < 0) {
    throw Error("system", "no file descriptor for signals is left", "raise the limit (ulimit -n)");
  }
}

StopSignal::~StopSignal() {
  ::close(descriptor_);
}

bool StopSignal::wait(int other_descriptor, int third_descriptor) {
  pollfd entries[3] = {
      {descriptor_, POLLIN, 0}, {other_descriptor, POLLIN, 0}, {third_descriptor, POLLIN, 0}};
  while (::poll(entries, 3, -1) < 0 && errno == EINTR) {
  }
  return entries[0].revents != 0;
}

bool StopSignal::wait_for(int timeout_ms, int other_descriptor) {
  pollfd entries[2] = {{descriptor_, POLLIN, 0}, {other_descriptor, POLLIN, 0}};
  return ::poll(entries, 2, timeout_ms) > 0 && entries[0].revents != 0;
}

}  // namespace irdm
