#include "device_bridge/link/link_probe.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <stdexcept>
#include <thread>

#include "common/contact/contact_model.hpp"
#include "common/error.hpp"
#include "common/number_text.hpp"
#include "common/realtime/clock.hpp"
#include "device_bridge/bridge.hpp"
#include "device_bridge/network_client.hpp"

namespace irdm {

void LinkMeasurement::tick(std::int64_t now_ns, std::int64_t late_ns,
                           const ServoInput& input) noexcept {
  ++ticks;
  wakeup.add(late_ns);
  if (!input.linked || !input.any_force) return;
  const std::int64_t age_ns = now_ns - input.force.sample_time_ns;
  age.add(age_ns);
  if (age_ns <= kHoldNs) ++young_for_hold;
  if (age_ns <= predict_limit_ns()) ++young_for_predict;
}

std::int64_t LinkMeasurement::predict_limit_ns() const noexcept {
  if (!(dt > 0.0)) return kPredictNs;
  return std::min<std::int64_t>(kPredictNs, std::llround(kNanosecondsPerSecond * kMaxHorizon * dt));
}

double LinkMeasurement::share(std::uint64_t count) const noexcept {
  return ticks > 0 ? static_cast<double>(count) / static_cast<double>(ticks) : 0.0;
}

double LinkMeasurement::loss() const noexcept {
  const std::uint64_t steps = client.forces + client.steps_missed;
  return steps > 0 ? static_cast<double>(client.steps_missed) / static_cast<double>(steps) : 0.0;
}

namespace {

constexpr std::int64_t kWarmUpNs = 100'000'000;      // of a session, not measured
constexpr std::int64_t kPatienceNs = 5'000'000'000;  // for the first session
const Vector3 kFarAway(0.0, 500.0, 0.0);             // where a tip touches nothing [m], W

/// A servo loop without a device.
class ProbeLoop {
 public:
  ProbeLoop(ServoLink& link, double rate, double duration, EventFd& done)
      : link_(link), rate_(rate), duration_(duration), done_(done) {}
  ~ProbeLoop() { stop(); }

  void start(RealTimeScheduling scheduling) {
    thread_ = std::thread([this] { run(); });
    measured_.scheduling = apply_scheduling(scheduling, thread_, kServoPriority);
  }
  void stop() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
  }
  /// After stop().
  const LinkMeasurement& measured() const noexcept { return measured_; }

 private:
  void run() noexcept;
  void say(std::int64_t now_ns) noexcept;

  ServoLink& link_;
  double rate_;
  double duration_;
  EventFd& done_;
  LinkMeasurement measured_;
  std::uint64_t sequence_ = 0;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

void ProbeLoop::say(std::int64_t now_ns) noexcept {
  link_.styluses[0].sample.put({.sequence = sequence_++, .time_ns = now_ns, .tip = kFarAway});
  link_.samples_ready.signal();
  link_.styluses[0].armed = true;  // nothing is to be felt
  link_.styluses[0].success_rate = 1.0;
}

void ProbeLoop::run() noexcept {
  const std::int64_t begin_ns = monotonic_ns();
  PeriodicSchedule schedule(begin_ns, std::llround(kNanosecondsPerSecond / rate_));
  std::int64_t from_ns = 0;  // 0: no session yet
  std::uint64_t missed_before = 0;
  while (!stop_) {
    const std::int64_t deadline_ns = schedule.next(monotonic_ns());
    sleep_until(deadline_ns);
    const std::int64_t now_ns = monotonic_ns();
    say(now_ns);
    link_.state.receive();
    link_.styluses[0].input.receive();
    if (from_ns == 0 && link_.state.front().sessions > 0) from_ns = now_ns + kWarmUpNs;
    if (from_ns == 0 && now_ns - begin_ns > kPatienceNs) break;
    if (from_ns == 0 || now_ns < from_ns) {
      missed_before = schedule.missed();
      continue;
    }
    measured_.dt = link_.state.front().dt;
    measured_.predict = link_.state.front().predict;
    measured_.tick(now_ns, now_ns - deadline_ns, link_.styluses[0].input.front());
    measured_.missed = schedule.missed() - missed_before;
    measured_.duration = static_cast<double>(now_ns - from_ns) / kNanosecondsPerSecond;
    if (measured_.duration >= duration_) break;
  }
  done_.signal();
}

}  // namespace

LinkMeasurement probe_link(const BridgeConfig& config, double duration, StopSignal& stop_signal) {
  EventFd done;
  ServoLink link(1);
  ClientSettings settings = client_settings(config);
  settings.name = "irdm-bridge check-link";
  settings.lockstep = false;
  NetworkClient client(link, settings, done);
  ProbeLoop loop(link, config.rate, duration, done);
  client.start();
  loop.start(config.realtime);
  stop_signal.wait(done.descriptor());
  loop.stop();
  client.stop(true);
  LinkMeasurement measured = loop.measured();
  measured.client = client.report();
  if (!measured.client.failure.empty()) throw std::runtime_error(measured.client.failure);
  if (measured.ticks == 0) {
    throw Error(address_text(config.server->host, config.server->port),
                "no session, and so nothing was measured",
                "start irdm-server there, with a stylus that no other bridge has");
  }
  return measured;
}

}  // namespace irdm
