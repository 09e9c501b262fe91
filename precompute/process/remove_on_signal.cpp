#include "precompute/process/remove_on_signal.hpp"

#include <unistd.h>

#include <array>
#include <cassert>
#include <csignal>
#include <string>

namespace irdm::precompute {
namespace {

constexpr std::array<int, 4> kSignals{SIGINT, SIGTERM, SIGHUP, SIGPIPE};

std::string file_to_remove;  // constant while the handlers are set

// Only calls that are safe in a signal handler.
void remove_and_die(int signal) {
  ::unlink(file_to_remove.c_str());
  std::signal(signal, SIG_DFL);
  ::raise(signal);
}

}  // namespace

RemoveOnSignal::RemoveOnSignal(const std::filesystem::path& file) {
  assert(file_to_remove.empty());
  file_to_remove = file.string();
  for (const int signal : kSignals) {
    if (std::signal(signal, remove_and_die) == SIG_IGN) std::signal(signal, SIG_IGN);
  }
}

RemoveOnSignal::~RemoveOnSignal() {
  for (const int signal : kSignals) {
    if (std::signal(signal, SIG_DFL) == SIG_IGN) std::signal(signal, SIG_IGN);
  }
  file_to_remove.clear();
}

}  // namespace irdm::precompute
