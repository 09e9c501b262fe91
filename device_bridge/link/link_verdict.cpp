#include "device_bridge/link/link_verdict.hpp"

#include <algorithm>
#include <array>
#include <iomanip>
#include <sstream>

#include "device_bridge/safety/arming.hpp"

namespace irdm {
namespace {

constexpr double kGoodSuccess = 0.99;
constexpr double kNoticeableLoss = 0.01;
constexpr double kNoticeableOverruns = 0.01;
constexpr std::int64_t kMillisecond = 1'000'000;
constexpr std::int64_t kLongJitterNs = 5 * kMillisecond;
constexpr std::int64_t kLateNs = 1 * kMillisecond;

double to_ms(std::int64_t ns) {
  return static_cast<double>(ns) / static_cast<double>(kMillisecond);
}

std::string percentiles(const Histogram& histogram) {
  if (histogram.count() == 0) return "none";
  std::ostringstream text;
  text << std::fixed << std::setprecision(3);
  for (const auto& [name, fraction] : std::array<std::pair<const char*, double>, 4>{
           {{"p50 ", 0.5}, {"p90 ", 0.9}, {"p99 ", 0.99}, {"p99.9 ", 0.999}}}) {
    text << name << to_ms(histogram.percentile(fraction)) << ", ";
  }
  text << "max " << to_ms(histogram.maximum()) << " ms";
  return text.str();
}

std::string percent(double share) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(2) << 100.0 * share << " %";
  return text.str();
}

/// Shares between limits that double from line to line, up to the largest value.
std::string bars(const Histogram& histogram) {
  constexpr double kWidth = 40.0;
  std::ostringstream text;
  double below = 0.0;
  for (std::int64_t limit = kMillisecond / 16; below < 1.0 && histogram.count() > 0; limit *= 2) {
    const double up_to = histogram.share_up_to(limit);
    const auto length = static_cast<std::size_t>(kWidth * (up_to - below) + 0.5);
    text << "  up to " << std::setw(9) << std::fixed << std::setprecision(3) << to_ms(limit)
         << " ms " << std::setw(8) << percent(up_to - below) << (length > 0 ? " " : "")
         << std::string(length, '#') << '\n';
    below = up_to;
  }
  return text.str();
}

LinkGrade grade_of(double success) {
  if (success >= kGoodSuccess) return LinkGrade::kGood;
  return success >= LinkGate::kNeeded ? LinkGrade::kPassable : LinkGrade::kBad;
}

/// Share of the steps that the server skipped meanwhile.
double server_overruns(const ClientReport& client) {
  if (!client.server || client.server->steps <= client.server_at_first->steps) return 0.0;
  const auto since = [](std::uint64_t now, std::uint64_t before) {
    return static_cast<double>(now - std::min(now, before));
  };
  const double missed = since(client.server->missed, client.server_at_first->missed);
  return missed / (missed + since(client.server->steps, client.server_at_first->steps));
}

std::string of_server(const wire::Status& status) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(1) << "step p50 " << status.step_time.median << ", p99 "
       << status.step_time.p99 << ", max " << status.step_time.maximum << " us, wake-up p99 "
       << status.wakeup_delay.p99 << " us, overruns " << status.missed << " of " << status.steps
       << " steps, lost in full queues " << status.overflows << ", " << status.surface_rate
       << " surfaces/s";
  return text.str();
}

const char* word(LinkGrade grade) {
  switch (grade) {
    case LinkGrade::kGood:
      return "good: fit for a hand";
    case LinkGrade::kPassable:
      return "passable: a stylus arms, and its force will fade now and then";
    case LinkGrade::kBad:
      return "bad: a stylus does not arm on it";
  }
  return "";
}

}  // namespace

LinkVerdict judge(const LinkMeasurement& link) {
  LinkVerdict verdict{.grade = grade_of(link.success())};
  const auto advise = [&](bool when, const char* what) {
    if (when) verdict.advice.emplace_back(what);
  };
  const std::int64_t round_trip = link.client.round_trip.percentile(0.5);
  advise(link.client.round_trip.count() == 0,
         "The server answers nothing: look at its log, and whether its run is paused or ended.");
  advise(round_trip > link.limit_ns(),
         "The round trip alone is longer than a force is shown: run the server nearer to the "
         "device, in the same network best.");
  advise(link.client.jitter.percentile(0.99) > kLongJitterNs,
         "The delay varies much: use a cable instead of radio, and keep other traffic off it.");
  advise(
      !link.predict && link.hold_success() < kGoodSuccess && link.predict_success() >= kGoodSuccess,
      "Forces are held, and come too late for that: set bridge.mode = \"predict\", which looks "
      "ahead.");
  advise(link.loss() > kNoticeableLoss,
         "Steps get lost on the way: look for a slow or crowded piece of the network, and whether "
         "the server says that it replaces forces.");
  advise(link.client.sessions > 1,
         "The connection broke and was made anew: look for the reason in both logs.");
  advise(link.wakeup.percentile(0.99) > kLateNs,
         "This machine wakes the loop late: allow real-time scheduling (rtprio in "
         "/etc/security/limits.d), end other programs, switch power saving off.");
  advise(server_overruns(link.client) > kNoticeableOverruns,
         "The server skips steps: give it a faster machine, a smaller model, or real-time "
         "scheduling.");
  advise(!link.predict && 2e9 * link.dt > static_cast<double>(LinkMeasurement::kHoldNs),
         "The server's step is too long for a held force: use a model with a shorter dt.");
  return verdict;
}

std::string to_text(const LinkMeasurement& link) {
  const LinkVerdict verdict = judge(link);
  const ClientReport& client = link.client;
  std::ostringstream text;
  text << std::fixed << std::setprecision(1);
  text << "link: " << link.duration << " s, " << link.ticks << " ticks, " << client.sessions
       << " sessions, server's step " << 1e3 * link.dt << " ms\n";
  if (client.datagram_sessions > 0) {
    text << "datagrams: " << client.datagrams << " received in " << client.datagram_sessions
         << " sessions, " << client.datagrams_dropped << " dropped\n";
  }
  text << "success: " << percent(link.success()) << " of the ticks have a force of at most "
       << to_ms(link.limit_ns()) << " ms, as "
       << (link.predict ? "solving the contact at the bridge needs ("
                        : "holding the server's forces needs (")
       << percent(link.predict ? link.hold_success() : link.predict_success()) << " of at most "
       << to_ms(link.predict ? LinkMeasurement::kHoldNs : link.predict_limit_ns()) << " ms)\n";
  text << "round trip: " << percentiles(client.round_trip) << '\n';
  text << "age: " << percentiles(link.age) << '\n';
  text << "loss: " << percent(link.loss()) << " of the server's steps, in " << client.gaps
       << " gaps, the longest of " << client.longest_gap << " steps\n";
  text << "jitter: " << percentiles(client.jitter) << '\n' << bars(client.jitter);
  text << "loop: " << link.missed << " ticks missed, wake-up " << percentiles(link.wakeup)
       << ", scheduling " << link.scheduling << '\n';
  if (client.server) text << "server: " << of_server(*client.server) << '\n';
  text << "verdict: " << word(verdict.grade) << '\n';
  for (const std::string& advice : verdict.advice) text << "advice: " << advice << '\n';
  return text.str();
}

}  // namespace irdm
