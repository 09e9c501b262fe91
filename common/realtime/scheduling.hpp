#pragma once

#include <string>
#include <string_view>
#include <thread>

namespace irdm {

/// Whether a thread is to run under real-time scheduling (SCHED_FIFO).
enum class RealTimeScheduling {
  kRequire,  ///< without it the program does not start
  kPrefer,   ///< with it where the system permits
  kIgnore,   ///< not asked for
};

/// Priorities under SCHED_FIFO: the servo loop goes before the force step, and both go before the
/// network threads that serve them.
inline constexpr int kServoPriority = 70;
inline constexpr int kForcePriority = 60;
inline constexpr int kNetworkPriority = 50;

/// What to do where the system permits neither it nor locked memory.
inline constexpr std::string_view kRealTimeRemedy =
    "add `@GROUP - rtprio 90` and `@GROUP - memlock unlimited` for a group of yours to "
    "/etc/security/limits.d and log in again, or set realtime = \"prefer\"";

/// "require", "prefer" or "ignore". Throws std::out_of_range for other words.
RealTimeScheduling scheduling_from_word(const std::string& word);

/// Puts a running thread under SCHED_FIFO as wanted. Returns what came of it in a few words for a
/// report. Throws Error when it is required and the system does not permit it. Called by the
/// thread's starter, not by the thread.
std::string apply_scheduling(RealTimeScheduling wanted, std::thread& thread, int priority);

}  // namespace irdm
