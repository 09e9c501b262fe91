#include "common/realtime/scheduling.hpp"

#include <pthread.h>
#include <sched.h>

#include <map>
#include <system_error>

#include "common/error.hpp"

namespace irdm {

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
