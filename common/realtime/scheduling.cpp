#include "common/realtime/scheduling.hpp"

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <cerrno>
#include <map>
#include <system_error>

#include "common/error.hpp"

namespace irdm {

std::string lock_memory(RealTimeScheduling wanted) {
  if (wanted == RealTimeScheduling::kIgnore) return "not locked";
#ifdef IRDM_SANITIZED
  return "not locked (its shadow is too large)";
#else
  if (::mlockall(MCL_CURRENT) == 0) return "locked";
  const std::string reason = std::generic_category().message(errno);
  ::munlockall();  // it may have come half-way
  if (wanted == RealTimeScheduling::kRequire) {
    throw Error("locked memory", reason, std::string(kRealTimeRemedy));
  }
  return "not locked (" + reason + ")";
#endif
}

cpu_set_t all_but_last(const cpu_set_t& cpus) noexcept {
  cpu_set_t rest = cpus;
  if (CPU_COUNT(&cpus) < 2) return rest;
  int last = CPU_SETSIZE - 1;
  while (!CPU_ISSET(last, &rest)) --last;
  CPU_CLR(last, &rest);
  return rest;
}

void spare_last_cpu() noexcept {
  cpu_set_t cpus;
  if (::sched_getaffinity(0, sizeof cpus, &cpus) != 0) return;
  const cpu_set_t rest = all_but_last(cpus);
  ::sched_setaffinity(0, sizeof rest, &rest);
}

RealTimeScheduling scheduling_from_word(const std::string& word) {
  static const std::map<std::string, RealTimeScheduling> kWords{
      {"require", RealTimeScheduling::kRequire},
      {"prefer", RealTimeScheduling::kPrefer},
      {"ignore", RealTimeScheduling::kIgnore}};
  return kWords.at(word);
}

std::string apply_scheduling(RealTimeScheduling wanted, std::thread& thread, int priority) {
  if (wanted == RealTimeScheduling::kIgnore) return "not asked for";
  sched_param parameters{};
  parameters.sched_priority = priority;
  // Returns its error; errno is not set.
  const int error = pthread_setschedparam(thread.native_handle(), SCHED_FIFO, &parameters);
  if (error == 0) return "SCHED_FIFO " + std::to_string(priority);
  const std::string reason = std::generic_category().message(error);
  if (wanted == RealTimeScheduling::kRequire) {
    throw Error("real-time scheduling", reason, std::string(kRealTimeRemedy));
  }
  return "none (" + reason + ")";
}

}  // namespace irdm
