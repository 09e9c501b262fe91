#include <catch2/catch.hpp>

#include "common/realtime/clock.hpp"

using irdm::PeriodicSchedule;

TEST_CASE("schedule keeps absolute deadlines when the loop is in time") {
  PeriodicSchedule schedule(1000, 100);
  CHECK(schedule.next(1010) == 1100);
  CHECK(schedule.next(1190) == 1200);
  CHECK(schedule.missed() == 0);
}

TEST_CASE("schedule runs a period that starts late but is not over") {
  PeriodicSchedule schedule(1000, 100);
  CHECK(schedule.next(1199) == 1100);
  CHECK(schedule.missed() == 0);
}

TEST_CASE("schedule skips whole periods after a stall, counts them and does not burst") {
  PeriodicSchedule schedule(1000, 100);
  CHECK(schedule.next(1450) == 1400);
  CHECK(schedule.missed() == 3);
  CHECK(schedule.next(1460) == 1500);
  CHECK(schedule.missed() == 3);
}
