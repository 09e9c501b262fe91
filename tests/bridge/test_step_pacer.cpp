#include <algorithm>
#include <cmath>
#include <deque>
#include <random>

#include "device_bridge/contact/step_pacer.hpp"
#include "tests/bridge/milliseconds.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;
using irdm::test::kMs;

namespace {

constexpr std::int64_t kPacerTickNs = kMs;
constexpr std::int64_t kStepNs = 2 * kMs;
constexpr double kPacerDt = 1e-9 * kStepNs;

struct ServerSteps {
  std::int64_t length_ns = kStepNs;
  std::int64_t phase_ns = 700'000;  ///< of the first, to the bridge's ticks
};

/// A bridge and a server, each with a clock of its own, and what lies between them.
class Pair {
 public:
  struct Way {
    std::int64_t delay_ns = 0;
    std::int64_t jitter_ns = 0;
    double drift = 0.0;  ///< by which the server's clock is faster
  };

  explicit Pair(const Way& way, const ServerSteps& steps = {})
      : pacer(1e-9 * static_cast<double>(steps.length_ns), kPacerTickNs),
        way_(way),
        steps_(steps) {}

  /// One tick of the bridge; the server's steps fall in between.
  void tick() {
    now_ns_ += kPacerTickNs;
    for (; server_due() <= now_ns_; ++server_step_) serve();
    deliver(down_, [&](const Down& it) { pacer.hear(it.step, it.newest, in_contact, now_ns_); });
    const int count = pacer.due(now_ns_);
    most_at_once = std::max(most_at_once, count);
    if (count > 0) up_.push_back({now_ns_ + way(), pacer.step()});
  }
  void ticks(int count) {
    for (int i = 0; i < count; ++i) tick();
  }
  /// Steps of the server for which the force had not come, since the last call.
  int late() { return std::exchange(late_, 0); }
  std::int64_t lead() const { return static_cast<std::int64_t>(pacer.step() - server_step_); }
  /// The server misses so many periods.
  void stall(int steps) { stalled_ns_ += steps * steps_.length_ns; }
  void set(const Way& way) { way_ = way; }

  StepPacer pacer;
  int most_at_once = 0;
  bool in_contact = false;

 private:
  struct Down {
    std::int64_t at_ns;
    std::uint64_t step;
    std::optional<std::uint64_t> newest;
  };
  struct Up {
    std::int64_t at_ns;
    std::uint64_t step;
  };

  std::int64_t server_due() const {
    const auto elapsed = static_cast<double>(steps_.length_ns) * static_cast<double>(server_step_);
    return std::llround(elapsed * (1.0 - way_.drift)) + steps_.phase_ns + stalled_ns_;
  }
  std::int64_t way() {
    const std::int64_t late = static_cast<std::int64_t>(random_() % 1000) * way_.jitter_ns / 1000;
    return way_.delay_ns + late;
  }
  void serve() {
    const std::int64_t at = server_due();
    for (std::size_t i = 0; i < up_.size();) {
      if (up_[i].at_ns > at) {
        ++i;
        continue;
      }
      if (!newest_ || up_[i].step > *newest_) newest_ = up_[i].step;
      up_.erase(up_.begin() + static_cast<std::ptrdiff_t>(i));
    }
    late_ += newest_ && *newest_ < server_step_ ? 1 : 0;
    down_.push_back({at + way(), server_step_, newest_});
  }
  template <typename Messages, typename Take>
  void deliver(Messages& messages, const Take& take) {
    std::uint64_t newest = 0;
    for (std::size_t i = 0; i < messages.size();) {
      if (messages[i].at_ns > now_ns_) {
        ++i;
        continue;
      }
      if (messages[i].step >= newest) take(messages[i]);
      newest = messages[i].step;
      messages.erase(messages.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }

  Way way_;
  ServerSteps steps_;
  std::int64_t now_ns_ = 0;
  std::int64_t stalled_ns_ = 0;
  std::uint64_t server_step_ = 0;
  std::optional<std::uint64_t> newest_;
  std::deque<Down> down_;
  std::deque<Up> up_;
  int late_ = 0;
  std::mt19937 random_{1};
};

}  // namespace

TEST_CASE("step pacer: forces are in time over any delay, and not more ahead than they must be") {
  for (const std::int64_t delay : {0, 1, 2, 5, 10, 20}) {
    for (const std::int64_t jitter : {0, 3, 10}) {
      CAPTURE(delay, jitter);
      Pair pair({.delay_ns = delay * kMs, .jitter_ns = jitter * kMs});
      pair.ticks(2000);
      pair.late();
      pair.ticks(20000);
      // Jitter has no upper end that is known beforehand: now and then a force is the latest so
      // far.
      CHECK(pair.late() <= (jitter > 0 ? 500 : 0));
      const auto needed = static_cast<std::int64_t>(
          std::ceil(static_cast<double>(delay + jitter) * kMs / static_cast<double>(kStepNs)));
      CHECK(pair.lead() <= needed + 4);
    }
  }
}

// With steps as short as a tick a new model comes before each end of a step.
TEST_CASE("step pacer: a step may be as short as a tick, or half of one, in any phase") {
  for (const std::int64_t length : {kMs / 2, kMs, 3 * kMs / 2}) {
    for (std::int64_t phase = 0; phase < kMs; phase += kMs / 20) {
      for (const std::int64_t jitter : {std::int64_t{0}, kMs / 10}) {
        CAPTURE(length, phase, jitter);
        Pair pair({.delay_ns = kMs / 20, .jitter_ns = jitter}, {length, phase});
        pair.ticks(300);
        pair.late();
        pair.ticks(5000);
        CHECK(pair.late() <= (jitter > 0 ? 5 : 0));
        CHECK(pair.lead() >= 0);
        CHECK(pair.lead() <= 5);
      }
    }
  }
}

TEST_CASE("step pacer: a clock that is fast or slow is followed a step at a time") {
  for (const double drift : {1e-3, -1e-3}) {
    Pair pair({.delay_ns = 5 * kMs, .drift = drift});
    pair.ticks(1000);
    pair.late();
    pair.most_at_once = 0;
    pair.ticks(60000);  // the clocks are 60 ms apart by now, 30 steps
    // A fast server is noticed a round trip after the first force was late, 30 times.
    CHECK(pair.late() <= 30 * 7);
    CHECK(pair.lead() >= 2);
    CHECK(pair.lead() <= 6);
    CHECK(pair.most_at_once <= 2);
  }
}

TEST_CASE(
    "step pacer: a server that stalls is waited for, and a way that gets longer is caught up") {
  Pair pair({.delay_ns = 2 * kMs});
  pair.ticks(1000);
  pair.stall(20);
  pair.ticks(3000);
  CHECK(pair.lead() <= 4);
  pair.set({.delay_ns = 15 * kMs});
  pair.ticks(200);
  pair.late();
  pair.ticks(3000);
  CHECK(pair.late() == 0);
  CHECK(pair.lead() <= 12);
}

TEST_CASE("step pacer: after a sleep it begins anew with what it hears") {
  StepPacer pacer(kPacerDt, kPacerTickNs);
  CHECK(pacer.due(0) == 0);
  pacer.hear(100, std::nullopt, false, -kPacerTickNs);
  CHECK(pacer.due(0) == 1);
  CHECK(pacer.step() == 102);
  CHECK(pacer.due(kPacerTickNs) == 0);
  CHECK(pacer.due(2 * kPacerTickNs) == 1);
  CHECK(pacer.end_of(103, 2 * kPacerTickNs) == 2 * kPacerTickNs);
  CHECK(pacer.end_of(102, 2 * kPacerTickNs) == 0);
  CHECK(pacer.due(1000 * kMs) == 0);
  CHECK_FALSE(pacer.running());
  pacer.hear(600, 103, false, 999 * kMs);
  CHECK(pacer.due(1000 * kMs) == 1);
  CHECK(pacer.step() == 602);
}

TEST_CASE("step pacer: nothing is hurried or put off while in contact, unless it must be") {
  Pair pair({.delay_ns = 2 * kMs});
  pair.ticks(1000);
  pair.in_contact = true;
  pair.most_at_once = 0;
  pair.set({.delay_ns = 6 * kMs});
  const std::int64_t lead = pair.lead();
  pair.ticks(3000);
  CHECK(pair.most_at_once == 1);
  CHECK(pair.lead() == lead);
  pair.in_contact = false;
  pair.ticks(300);
  CHECK(pair.lead() >= lead + 2);
  pair.in_contact = true;
  pair.set({.delay_ns = 40 * kMs});
  pair.ticks(3000);
  CHECK(pair.lead() >= 12);
}
