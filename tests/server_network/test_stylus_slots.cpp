#include "server/network/stylus_slots.hpp"
#include "tests/support/catch.hpp"

using irdm::StylusSample;
using irdm::StylusSlots;

TEST_CASE("slots are claimed in a row and given back") {
  StylusSlots slots(4);
  CHECK(slots.claim(1) == 0);
  CHECK(slots.claim(2) == 1);
  CHECK(slots.claim(2) == std::nullopt);
  slots.release(0, 1);
  CHECK(slots.claim(2) == std::nullopt);  // 0 and 3 are free, but not neighbours
  slots.release(1, 2);
  CHECK(slots.claim(3) == 0);
}

TEST_CASE("only samples with a growing sequence get through") {
  StylusSlots slots(1);
  slots.claim(1);
  CHECK(slots.put(0, {.sequence = 5}, 0));
  CHECK(slots.put(0, {.sequence = 7}, 0));
  CHECK_FALSE(slots.put(0, {.sequence = 7}, 0));
  CHECK_FALSE(slots.put(0, {.sequence = 6}, 0));
  REQUIRE(slots.port(0).in.receive());
  CHECK(slots.port(0).in.front().sample.sequence == 7);
  slots.release(0, 1);
  slots.claim(1);
  CHECK(slots.put(0, {.sequence = 0}, 0));  // a new session counts anew
}

TEST_CASE("a stylus is absent without a session, and without samples for too long") {
  StylusSlots slots(1);
  slots.claim(1);
  slots.put(0, {.sequence = 1}, 1000);
  slots.expire(1100, 100);
  REQUIRE(slots.port(0).in.receive());
  CHECK(slots.port(0).in.front().present);
  slots.expire(1101, 100);
  REQUIRE(slots.port(0).in.receive());
  CHECK_FALSE(slots.port(0).in.front().present);
  slots.expire(1200, 100);
  CHECK_FALSE(slots.port(0).in.receive());  // said once

  slots.put(0, {.sequence = 2}, 1300);
  REQUIRE(slots.port(0).in.receive());
  CHECK(slots.port(0).in.front().present);
  slots.release(0, 1);
  REQUIRE(slots.port(0).in.receive());
  CHECK_FALSE(slots.port(0).in.front().present);
}

TEST_CASE("a force for an owner that has gone does not reach the next one") {
  StylusSlots slots(1);
  slots.claim(1);
  CHECK_FALSE(slots.take_force(0));
  slots.put(0, {.sequence = 10, .time_ns = 1000}, 0);
  slots.port(0).out.put({.sample_sequence = 10, .sample_time_ns = 1000});
  CHECK(slots.take_force(0));
  CHECK_FALSE(slots.take_force(0));  // once

  slots.release(0, 1);
  slots.claim(1);
  slots.port(0).out.put({.sample_sequence = 10, .sample_time_ns = 1000});
  CHECK_FALSE(slots.take_force(0));  // no sample of this owner yet
  slots.put(0, {.sequence = 3, .time_ns = 2000}, 0);
  slots.port(0).out.put({.sample_sequence = 10, .sample_time_ns = 3000});
  CHECK_FALSE(slots.take_force(0));  // a sample that this owner has not sent yet
  slots.port(0).out.put({.sample_sequence = 1, .sample_time_ns = 1000});
  CHECK_FALSE(slots.take_force(0));  // a sample from before this owner
  slots.port(0).out.put({.sample_sequence = 3, .sample_time_ns = 2000});
  CHECK(slots.take_force(0));
}
