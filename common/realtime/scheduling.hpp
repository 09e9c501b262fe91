#pragma once

#include <sched.h>
#include <string>
#include <string_view>
#include <thread>

namespace irdm {

/// All of these but the last; the same set when there are less than two.
cpu_set_t all_but_last(const cpu_set_t& cpus) noexcept;

/// Keeps the calling thread, and threads that it makes from here on, off the last of the processors
/// that it may run on: there is always one that a real-time thread finds free of them. Does nothing
/// where there is only one.
void spare_last_cpu() noexcept;

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

/// Keeps all memory that this process has now in RAM, so that no real-time thread waits for a page
/// to come in. Called when all that they touch has been made: what comes later is not locked (a
/// limit would then end an allocation), but for the stacks of real-time threads, which see to that
/// themselves (RealTimeScope). Returns what came of it in a few words for a report. Throws Error
/// when it is required and the system does not permit it. Does nothing in a sanitizer's build.
std::string lock_memory(RealTimeScheduling wanted);

}  // namespace irdm
