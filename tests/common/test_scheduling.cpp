#include <pthread.h>

#include <latch>

#include "common/error.hpp"
#include "common/realtime/scheduling.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;

TEST_CASE("scheduling does what it reports") {
  std::latch done(1);
  std::thread thread([&] { done.wait(); });
  const auto policy = [&] {
    int value = -1;
    sched_param parameters{};
    pthread_getschedparam(thread.native_handle(), &value, &parameters);
    return value;
  };
  CHECK(apply_scheduling(RealTimeScheduling::kIgnore, thread, kForcePriority) == "not asked for");
  CHECK(policy() == SCHED_OTHER);
  const std::string preferred =
      apply_scheduling(RealTimeScheduling::kPrefer, thread, kForcePriority);
  if (policy() == SCHED_FIFO) {
    CHECK(preferred == "SCHED_FIFO 60");
    CHECK_NOTHROW(apply_scheduling(RealTimeScheduling::kRequire, thread, kForcePriority));
  } else {
    CHECK_THAT(preferred, Catch::Matchers::ContainsSubstring("none ("));
    CHECK_THROWS_AS(apply_scheduling(RealTimeScheduling::kRequire, thread, kForcePriority), Error);
  }
  done.count_down();
  thread.join();
}

TEST_CASE("scheduling words are the three of the configuration") {
  CHECK(scheduling_from_word("require") == RealTimeScheduling::kRequire);
  CHECK(scheduling_from_word("prefer") == RealTimeScheduling::kPrefer);
  CHECK(scheduling_from_word("ignore") == RealTimeScheduling::kIgnore);
  CHECK_THROWS(scheduling_from_word("fast"));
}
