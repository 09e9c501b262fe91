#include <string>

#include "device_bridge/link/link_verdict.hpp"
#include "tests/bridge/milliseconds.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;
using Catch::Matchers::ContainsSubstring;
using irdm::test::kMs;

namespace {

/// A link of 1000 ticks with nothing wrong, of which `old` have a force of 30 ms.
LinkMeasurement link_with(int old) {
  LinkMeasurement link;
  std::int64_t now_ns = 0;
  for (int i = 0; i < 1000; ++i, now_ns += kMs) {
    const std::int64_t age_ns = i < old ? 30 * kMs : 2 * kMs;
    link.tick(now_ns, 10'000,
              {.linked = true, .any_force = true, .force = {.sample_time_ns = now_ns - age_ns}});
    link.client.round_trip.add(kMs);
    link.client.jitter.add(kMs / 10);
  }
  link.duration = 1.0;
  link.dt = 0.002;
  link.scheduling = "none";
  link.client.sessions = 1;
  link.client.forces = 500;
  return link;
}

/// What is advised when this is wrong with a link.
template <typename Fault>
std::string advice(const Fault& fault) {
  LinkMeasurement link = link_with(0);
  fault(link);
  const LinkVerdict verdict = judge(link);
  return verdict.advice.size() == 1 ? verdict.advice.front()
                                    : std::to_string(verdict.advice.size());
}

void add(Histogram& histogram, std::int64_t ns) {
  for (int i = 0; i < 5000; ++i) histogram.add(ns);
}

}  // namespace

TEST_CASE("a link's ticks count by the age of the newest force; none counts without a session") {
  LinkMeasurement link = link_with(100);
  CHECK(link.hold_success() == 0.9);
  CHECK(link.predict_success() == 1.0);
  CHECK(link.age.maximum() == 30 * kMs);
  for (int i = 0; i < 1000; ++i) {
    link.tick(2000 * kMs, 0, {.linked = i < 500, .force = {.sample_time_ns = 2000 * kMs}});
  }
  CHECK(link.hold_success() == 0.45);
  CHECK(link.age.count() == 1000);
  CHECK(LinkMeasurement{}.hold_success() == 0.0);
}

TEST_CASE("a link is graded by the share of ticks that were answered in time") {
  CHECK(judge(link_with(0)).grade == LinkGrade::kGood);
  CHECK(judge(link_with(10)).grade == LinkGrade::kGood);
  CHECK(judge(link_with(11)).grade == LinkGrade::kPassable);
  CHECK(judge(link_with(100)).grade == LinkGrade::kPassable);
  CHECK(judge(link_with(101)).grade == LinkGrade::kBad);
  CHECK(judge(LinkMeasurement{}).grade == LinkGrade::kBad);
  CHECK(judge(link_with(0)).advice.empty());
}

TEST_CASE("a link is graded by what its mode needs: a bridge that predicts has a horizon") {
  LinkMeasurement link = link_with(1000);
  CHECK(judge(link).grade == LinkGrade::kBad);
  CHECK_THAT(judge(link).advice.front(), ContainsSubstring("bridge.mode"));
  link.predict = true;
  CHECK(judge(link).grade == LinkGrade::kGood);
  CHECK(judge(link).advice.empty());
  add(link.client.round_trip, 45 * kMs);
  CHECK(judge(link).advice.empty());
  add(link.client.round_trip, 55 * kMs);
  add(link.client.round_trip, 55 * kMs);
  CHECK_THAT(judge(link).advice.front(), ContainsSubstring("nearer to the device"));
}

TEST_CASE("a contact model predicts 50 steps, and at most 50 ms") {
  LinkMeasurement link;
  CHECK(link.predict_limit_ns() == 50 * kMs);
  link.dt = 0.002;
  CHECK(link.predict_limit_ns() == 50 * kMs);
  link.dt = 0.0005;
  link.predict = true;
  CHECK(link.limit_ns() == 25 * kMs);
  link.tick(100 * kMs, 0,
            {.linked = true, .any_force = true, .force = {.sample_time_ns = 76 * kMs}});
  link.tick(100 * kMs, 0,
            {.linked = true, .any_force = true, .force = {.sample_time_ns = 74 * kMs}});
  CHECK(link.success() == 0.5);
}

TEST_CASE("each fault of a link has its advice") {
  CHECK_THAT(advice([](auto& link) { link.client.round_trip = Histogram{}; }),
             ContainsSubstring("answers nothing"));
  CHECK_THAT(advice([](auto& link) { add(link.client.round_trip, 25 * kMs); }),
             ContainsSubstring("nearer to the device"));
  CHECK_THAT(advice([](auto& link) { add(link.client.jitter, 6 * kMs); }),
             ContainsSubstring("cable"));
  CHECK_THAT(advice([](auto& link) { link.client.steps_missed = 10; }),
             ContainsSubstring("Steps get lost"));
  CHECK_THAT(advice([](auto& link) { link.client.sessions = 2; }), ContainsSubstring("made anew"));
  CHECK_THAT(advice([](auto& link) { add(link.wakeup, 2 * kMs); }),
             ContainsSubstring("real-time scheduling"));
  CHECK_THAT(advice([](auto& link) {
               link.client.server_at_first = wire::Status{.steps = 1000, .missed = 500};
               link.client.server = wire::Status{.steps = 1490, .missed = 510};
             }),
             ContainsSubstring("server skips steps"));
  CHECK_THAT(advice([](auto& link) { link.dt = 0.015; }), ContainsSubstring("shorter dt"));
}

TEST_CASE("a link's report says what was measured, with the verdict") {
  LinkMeasurement link = link_with(150);
  link.client.steps_missed = 500;
  link.client.server_at_first = link.client.server =
      wire::Status{.steps = 70, .missed = 3, .overflows = 2, .surface_rate = 60.0F};
  const std::string text = to_text(link);
  CHECK_THAT(text,
             ContainsSubstring("link: 1.0 s, 1000 ticks, 1 sessions, server's step 2.0 ms\n"));
  CHECK_THAT(text, ContainsSubstring("success: 85.00 % of the ticks"));
  CHECK_THAT(text, ContainsSubstring(
                       "of at most 20.0 ms, as holding the server's forces needs (100.00 % of at "
                       "most 50.0 ms)"));
  link.predict = true;
  CHECK_THAT(to_text(link),
             ContainsSubstring("success: 100.00 % of the ticks have a force of at most 50.0 "
                               "ms, as solving the contact at the bridge needs (85.00 %"));
  CHECK_THAT(text, ContainsSubstring("loss: 50.00 %"));
  CHECK_THAT(text, ContainsSubstring("  up to     0.125 ms 100.00 % ###"));
  CHECK_THAT(text, ContainsSubstring("server: step p50 0.0") &&
                       ContainsSubstring(
                           "overruns 3 of 70 steps, lost in full queues 2, 60.0 surfaces/s"));
  CHECK_THAT(text, ContainsSubstring("verdict: bad"));
  CHECK_THAT(text, ContainsSubstring("advice: Steps get lost"));
}
