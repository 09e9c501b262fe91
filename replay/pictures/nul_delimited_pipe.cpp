#include "replay/pictures/nul_delimited_pipe.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <unistd.h>

#include <array>
#include <cerrno>

#include "common/error.hpp"

namespace irdm::replay {
namespace {

void close_end(int& descriptor) noexcept {
  if (descriptor >= 0) ::close(descriptor);
  descriptor = -1;
}

bool wait_for(int descriptor, short event, int patience_ms) {
  pollfd one{descriptor, event, 0};
  int ready = -1;
  do {
    ready = ::poll(&one, 1, patience_ms);
  } while (ready < 0 && errno == EINTR);
  return ready > 0;
}

}  // namespace

NulDelimitedPipe::NulDelimitedPipe() {
  ::signal(SIGPIPE, SIG_IGN);
  if (::pipe2(in_, O_CLOEXEC) == 0 && ::pipe2(out_, O_CLOEXEC) == 0) {
    ::fcntl(in_[1], F_SETFL, O_NONBLOCK);
    return;
  }
  close();
  close_its_ends();
  throw Error("pipe", "the system has no descriptor left", "raise the limit (ulimit -n)");
}

NulDelimitedPipe::~NulDelimitedPipe() {
  close();
  close_its_ends();
}

void NulDelimitedPipe::close_its_ends() noexcept {
  close_end(in_[0]);
  close_end(out_[1]);
}

void NulDelimitedPipe::close() noexcept {
  close_end(in_[1]);
  close_end(out_[0]);
}

bool NulDelimitedPipe::write(const std::string& text, int patience_ms) {
  // With the zero that a string ends with.
  for (std::size_t done = 0; done <= text.size();) {
    const ssize_t count = ::write(in_[1], text.c_str() + done, text.size() + 1 - done);
    if (count > 0) {
      done += static_cast<std::size_t>(count);
    } else if (errno != EAGAIN && errno != EINTR) {
      return false;
    } else if (!wait_for(in_[1], POLLOUT, patience_ms)) {
      return false;
    }
  }
  return true;
}

bool NulDelimitedPipe::read(std::string& text, int patience_ms) {
  std::array<char, 65536> block;
  std::size_t end = waiting_.find('\0');
  while (end == std::string::npos) {
    if (!wait_for(out_[0], POLLIN, patience_ms)) return false;
    const ssize_t count = ::read(out_[0], block.data(), block.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    const std::size_t before = waiting_.size();
    waiting_.append(block.data(), static_cast<std::size_t>(count));
    end = waiting_.find('\0', before);
  }
  text = waiting_.substr(0, end);
  waiting_.erase(0, end + 1);
  return true;
}

}  // namespace irdm::replay
