#include "precompute/process/signal_cleanup.hpp"

#include <unistd.h>

#include <array>
#include <cassert>
#include <csignal>

namespace irdm::precompute {
namespace {

constexpr std::array<int, 4> kSignals{SIGINT, SIGTERM, SIGHUP, SIGPIPE};

// Constant while the handlers are set.
std::string file_to_remove;
std::string last_words;

// Only calls that are safe in a signal handler.
void act_and_die(int signal) {
  if (!file_to_remove.empty()) ::unlink(file_to_remove.c_str());
  if (signal != SIGPIPE) {
    [[maybe_unused]] const ssize_t told =
        ::write(STDERR_FILENO, last_words.data(), last_words.size());
  }
  std::signal(signal, SIG_DFL);
  ::raise(signal);
}

}  // namespace

SignalCleanup::SignalCleanup(const CleanupAction& action) {
  assert(file_to_remove.empty() && last_words.empty());
  file_to_remove = action.remove.string();
  last_words = action.say;
  for (const int signal : kSignals) {
    if (std::signal(signal, act_and_die) == SIG_IGN) std::signal(signal, SIG_IGN);
  }
}

SignalCleanup::~SignalCleanup() {
  for (const int signal : kSignals) {
    if (std::signal(signal, SIG_DFL) == SIG_IGN) std::signal(signal, SIG_IGN);
  }
  file_to_remove.clear();
  last_words.clear();
}

}  // namespace irdm::precompute
