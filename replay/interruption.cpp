#include "replay/interruption.hpp"

#include <array>
#include <csignal>

namespace irdm::replay {
namespace {

constexpr std::array<int, 2> kInterrupting{SIGINT, SIGTERM};

volatile std::sig_atomic_t interrupted = 0;

void remember(int /*signal*/) {
  interrupted = 1;
}

}  // namespace

Interruption::Interruption() {
  interrupted = 0;
  for (const int signal : kInterrupting) {
    if (std::signal(signal, remember) == SIG_IGN) std::signal(signal, SIG_IGN);
  }
}

Interruption::~Interruption() {
  for (const int signal : kInterrupting) {
    if (std::signal(signal, SIG_DFL) == SIG_IGN) std::signal(signal, SIG_IGN);
  }
}

bool Interruption::came() const noexcept {
  return interrupted != 0;
}

}  // namespace irdm::replay
