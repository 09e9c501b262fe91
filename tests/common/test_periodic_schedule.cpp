#include "common/realtime/clock.hpp"
#include "tests/support/catch.hpp"

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

TEST_CASE("schedule makes up for a few periods, and skips more than that") {
  PeriodicSchedule schedule(1000, 100, 3);
  CHECK(schedule.next(1450) == 1100);
  CHECK(schedule.behind());
  CHECK(schedule.next(1450) == 1200);
  CHECK(schedule.next(1455) == 1300);
  CHECK(schedule.missed() == 3);
  CHECK(schedule.made_up() == 3);
  CHECK(schedule.next(1460) == 1400);
  CHECK_FALSE(schedule.behind());
  CHECK(schedule.next(1465) == 1500);
  CHECK(schedule.next(2010) == 2000);  // four periods are over
  CHECK_FALSE(schedule.behind());
  CHECK(schedule.missed() == 7);
  CHECK(schedule.made_up() == 3);
}

TEST_CASE("schedule skips whole periods after a stall, counts them and does not burst") {
  PeriodicSchedule schedule(1000, 100);
  CHECK(schedule.next(1450) == 1400);
  CHECK(schedule.missed() == 3);
  CHECK(schedule.next(1460) == 1500);
  CHECK(schedule.missed() == 3);
}
