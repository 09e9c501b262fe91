#include "device_bridge/commission/terminal.hpp"

#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <ostream>

namespace irdm::commission {
namespace {

/// While it lives, keys come one by one and without echo.
class KeyByKey {
 public:
  explicit KeyByKey(int descriptor) : descriptor_(descriptor) {
    changed_ = ::tcgetattr(descriptor, &before_) == 0;
    if (!changed_) return;
    termios keys = before_;
    keys.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
    // They would stop the process with the last force on.
    keys.c_cc[VSUSP] = keys.c_cc[VQUIT] = _POSIX_VDISABLE;
    ::tcsetattr(descriptor, TCSANOW, &keys);
  }
  KeyByKey(const KeyByKey&) = delete;
  KeyByKey& operator=(const KeyByKey&) = delete;
  ~KeyByKey() {
    if (changed_) ::tcsetattr(descriptor_, TCSANOW, &before_);
  }

 private:
  int descriptor_;
  termios before_{};
  bool changed_ = false;  ///< it is a terminal
};

bool readable(int descriptor) {
  pollfd wanted{.fd = descriptor, .events = POLLIN, .revents = 0};
  return ::poll(&wanted, 1, 0) > 0;
}

}  // namespace

void Terminal::tell(const std::string& line) {
  output_ << line << std::endl;
}

// None at the end of the input.
std::optional<char> Terminal::next_letter() {
  char letter = 0;
  ended_ = ended_ || ::read(input_, &letter, 1) <= 0;
  return ended_ ? std::nullopt : std::optional(letter);
}

// None when a signal came, or at the end of the input.
std::optional<std::string> Terminal::next_line() {
  std::string line;
  while (!ended_ && !signal_.wait(input_)) {
    const std::optional<char> letter = next_letter();
    if (letter == '\n') return line;
    if (letter) line += *letter;
  }
  return std::nullopt;
}

bool Terminal::begins(const Step& step) {
  output_ << '\n'
          << step.name() << ": " << step.request().words
          << "\n  Enter: begin; any key then stops it. q: end. " << std::flush;
  const std::optional<std::string> line = next_line();
  return line && *line != "q";
}

bool Terminal::confirms(const std::string& question) {
  output_ << '\n' << question << " [y/n] " << std::flush;
  const std::optional<std::string> line = next_line();
  return line && (*line == "y" || *line == "yes");
}

bool Terminal::stops(int timeout_ms) {
  const KeyByKey keys(input_);
  if (signal_.wait_for(timeout_ms, ended_ ? -1 : input_)) return true;
  return !ended_ && readable(input_) && next_letter();
}

bool SimulatedPerson::begins(const Step& step) {
  watcher_.tell("\n" + step.name() + ": " + step.request().words);
  stylus_.ask(step.request().order);
  return true;
}

}  // namespace irdm::commission
