#include "precompute/process/remove_on_signal.hpp"

#include <unistd.h>

#include <cassert>
#include <csignal>
#include <string>

namespace irdm::precompute {
namespace {

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
  std::signal(SIGINT, remove_and_die);
  std::signal(SIGTERM, remove_and_die);
}

RemoveOnSignal::~RemoveOnSignal() {
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
  file_to_remove.clear();
}

}  // namespace irdm::precompute
