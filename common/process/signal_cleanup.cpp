#include "common/process/signal_cleanup.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <mutex>

namespace irdm {
namespace {

constexpr std::array<int, 4> kSignals{SIGINT, SIGTERM, SIGHUP, SIGPIPE};

/// The handler reads what is set; it is written before and after that only.
struct Entry {
  std::atomic<bool> set = false;
  pid_t process = 0;  ///< that it belongs to
  pid_t kill = 0;
  std::string remove;
  std::string say;
};

std::array<Entry, 16> entries;
std::mutex changing;

// Only calls that are safe in a signal handler, here and below.
void remove_folder(const char* path) {
  const pid_t child = ::_Fork();
  if (child == 0) {
    ::execl("/bin/rm", "rm", "-rf", "--", path, nullptr);
    ::_exit(1);
  }
  if (child > 0) ::waitpid(child, nullptr, 0);
}

void act_and_die(int signal) {
  const pid_t own = ::getpid();
  const auto each = [own](auto&& act) {
    for (const Entry& entry : entries) {
      if (entry.set && entry.process == own) act(entry);
    }
  };
  // Children first: they write into the folders.
  each([](const Entry& entry) {
    if (entry.kill != 0) ::kill(entry.kill, SIGKILL);
  });
  each([](const Entry& entry) {
    if (entry.kill != 0) ::waitpid(std::abs(entry.kill), nullptr, 0);
  });
  each([](const Entry& entry) {
    if (entry.remove.empty() || ::unlink(entry.remove.c_str()) == 0) return;
    if (errno == EISDIR) remove_folder(entry.remove.c_str());
  });
  each([signal](const Entry& entry) {
    if (signal == SIGPIPE) return;
    [[maybe_unused]] const ssize_t told =
        ::write(STDERR_FILENO, entry.say.data(), entry.say.size());
  });
  std::signal(signal, SIG_DFL);
  ::raise(signal);
}

// Sets the handler of the signals that have `from`.
void replace_handlers(void (*from)(int), void (*to)(int)) {
  for (const int signal : kSignals) {
    struct sigaction now {};
    if (::sigaction(signal, nullptr, &now) == 0 && now.sa_handler == from) std::signal(signal, to);
  }
}

}  // namespace

SignalCleanup::SignalCleanup(const CleanupAction& action) {
  const std::scoped_lock lock(changing);
  const auto room = std::find_if(entries.begin(), entries.end(),
                                 [](const Entry& entry) { return !entry.set.load(); });
  if (room == entries.end()) return;
  place_ = static_cast<int>(room - entries.begin());
  room->process = ::getpid();
  room->kill = action.kill;
  room->remove = action.remove.string();
  room->say = action.say;
  room->set = true;
  replace_handlers(SIG_DFL, act_and_die);
}

SignalCleanup::~SignalCleanup() {
  if (place_ < 0) return;
  const std::scoped_lock lock(changing);
  entries[static_cast<std::size_t>(place_)].set = false;
  const bool any = std::any_of(entries.begin(), entries.end(),
                               [](const Entry& entry) { return entry.set.load(); });
  if (!any) replace_handlers(act_and_die, SIG_DFL);
}

}  // namespace irdm
