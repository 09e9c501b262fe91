#pragma once

#include <chrono>
#include <thread>

namespace irdm::test {

/// Generous: it only says when a test that hangs gives up.
inline constexpr int kDeadlineMs = 120'000;

/// Waits until `condition()` holds; false when it still does not at the deadline.
/// @param deadline_ms [ms]; longer for what real programs have to work for
template <typename Condition>
bool eventually(Condition condition, int deadline_ms = kDeadlineMs) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::milliseconds(deadline_ms);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

}  // namespace irdm::test
