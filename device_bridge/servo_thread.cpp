#include "device_bridge/servo_thread.hpp"

#include <algorithm>
#include <cmath>

#include "common/error.hpp"
#include "common/realtime/clock.hpp"
#include "common/realtime/real_time_scope.hpp"
#include "device_bridge/link/link_simulation.hpp"

namespace irdm {
namespace {

std::int64_t to_ns(double seconds) noexcept {
  return std::llround(seconds * kNanosecondsPerSecond);
}

}  // namespace

ServoThread::ServoThread(ServoLink& link, std::vector<ServoLoop>& loops,
                         const ServoSettings& settings, EventFd& done)
    : link_(link), loops_(loops), settings_(settings), done_(done) {}

ServoThread::~ServoThread() {
  stop();
}

void ServoThread::start() {
  find_source();
  if (source_ != nullptr) return start_source();
  thread_ = std::thread([this] { run(); });
  scheduling_ = apply_scheduling(settings_.scheduling, thread_, kServoPriority);
}

void ServoThread::stop() {
  if (source_ != nullptr) return stop_source();
  if (!thread_.joinable()) return;
  stop_ = true;
  link_.news.signal();
  thread_.join();
}

void ServoThread::find_source() {
  for (ServoLoop& loop : loops_) {
    TickSource* const source = loop.device().tick_source();
    if (source == nullptr || source == source_) continue;
    if (source_ != nullptr) {
      throw Error("devices", "two drivers want to make the ticks of the servo loop",
                  "run a bridge for each of them");
    }
    source_ = source;
  }
}

void ServoThread::start_source() {
  scheduling_ = "the driver's own";
  last_tick_ns_ = monotonic_ns();
  try {
    source_->start(settings_.rate, [this] { return source_tick(); });
  } catch (...) {
    source_ = nullptr;
    throw;
  }
}

void ServoThread::stop_source() {
  constexpr int kLongestFadeMs = 2000;
  stop_ = true;
  const bool ended = source_ended_.wait(kLongestFadeMs);
  source_->stop();
  source_ = nullptr;
  if (!ended) report_.end = ServoEnd::kDriverStuck;
}

bool ServoThread::driver_silent(std::int64_t now_ns) const noexcept {
  constexpr std::int64_t kLongestSilenceNs = 1'000'000'000;
  return source_ != nullptr && now_ns - last_tick_ns_ > kLongestSilenceNs;
}

// The driver's clock is not ours: how late a tick is, is told from the one before.
bool ServoThread::source_tick() noexcept {
  const NoDenormals here;  // the thread is the driver's, and so is how it computes
  const std::int64_t now_ns = monotonic_ns();
  const std::int64_t period_ns = to_ns(1.0 / settings_.rate);
  late_ns_ = now_ns - last_tick_ns_ - period_ns;
  last_tick_ns_ = now_ns;
  if (phase_ == Phase::kRunning) {
    report_.wakeup.add(late_ns_);
    if (late_ns_ > 0) report_.missed += static_cast<std::uint64_t>(late_ns_ / period_ns);
  }
  if (tick(now_ns)) return true;
  source_ended_.signal();
  done_.signal();
  return false;
}

void ServoThread::run() noexcept {
  const RealTimeScope scope("servo", settings_.scheduling);
  run_real_time();
  for (ServoLoop& loop : loops_) loop.rest();
  done_.signal();
}

void ServoThread::run_real_time() noexcept {
  PeriodicSchedule schedule(monotonic_ns(), to_ns(1.0 / settings_.rate));
  for (ServoLoop& loop : loops_) loop.rest();
  for (;;) {
    const std::int64_t deadline_ns = schedule.next(monotonic_ns());
    sleep_until(deadline_ns);
    const std::int64_t now_ns = monotonic_ns();
    late_ns_ = now_ns - deadline_ns;
    report_.wakeup.add(late_ns_);
    report_.missed = schedule.missed();
    if (!tick(now_ns)) return;
    if (report_.lockstep) {
      report_.end = settings_.link ? run_over_link() : run_lockstep();
      return;
    }
  }
}

// One tick in real time; false when it was the last.
bool ServoThread::tick(std::int64_t now_ns) noexcept {
  if (phase_ == Phase::kWaiting) wait_for_session(now_ns);
  if (phase_ == Phase::kRunning) {
    render_tick(now_ns);
  } else if (phase_ == Phase::kFading) {
    fade(now_ns);
  }
  return phase_ != Phase::kOver;
}

void ServoThread::wait_for_session(std::int64_t now_ns) noexcept {
  link_.state.receive();
  const LinkState& state = link_.state.front();
  if (state.sessions > 0 && !stop_) {
    for (ServoLoop& loop : loops_) loop.restart(!state.lockstep || settings_.link);
    report_.lockstep = state.lockstep;
    start_ns_ = now_ns;
    if (!state.lockstep) phase_ = Phase::kRunning;
    return;
  }
  bool lost = false;
  for (ServoLoop& loop : loops_) {
    if (loop.device().simulated()) continue;  // its time has not begun
    loop.idle(0.0);                           // a driver's watchdog wants to hear of us
    lost = lost || loop.device_state().lost;
  }
  report_.end = lost ? ServoEnd::kDeviceLost : ServoEnd::kStopped;
  if (lost || stop_) phase_ = Phase::kOver;
}

void ServoThread::render_tick(std::int64_t now_ns) noexcept {
  link_.state.receive();
  const LinkState& state = link_.state.front();
  if (session_ != state.sessions) begin_session(state);
  ++report_.ticks;
  report_.session_time = static_cast<double>(now_ns - start_ns_) / kNanosecondsPerSecond;
  bool lost = false;
  for (std::size_t i = 0; i < loops_.size(); ++i) {
    loops_[i].read(report_.session_time);
    link_.styluses[i].sample.put(loops_[i].take_sample(now_ns));
    end_steps(i, now_ns);
    link_.styluses[i].input.receive();
    loops_[i].apply(now_ns, link_.styluses[i].input.front());
    publish_applied(i);
    write_down(i, now_ns);
    lost = lost || loops_[i].device_state().lost;
    const SafetyFilter& filter = loops_[i].filter();
    link_.styluses[i].armed = filter.state() != FilterState::kDisarmed;
    link_.styluses[i].awaits_button = loops_[i].awaits_button();
    link_.styluses[i].success_rate = filter.success_rate();
    link_.styluses[i].gain = filter.gain();
    link_.styluses[i].energy_share = filter.energy_share();
  }
  link_.samples_ready.signal();
  if (lost) return end(ServoEnd::kDeviceLost, now_ns);
  if (report_.session_time >= settings_.duration) return end(ServoEnd::kFinished, now_ns);
  if (stop_) end(ServoEnd::kStopped, now_ns);
}

// For the black box.
void ServoThread::write_down(std::size_t i, std::int64_t now_ns) noexcept {
  if (settings_.log == nullptr) return;
  const ServoLoop& loop = loops_[i];
  const SafetyFilter& filter = loop.filter();
  const LinkState& state = link_.state.front();
  settings_.log->put({.time_ns = now_ns,
                      .stylus = static_cast<int>(i),
                      .late_ns = late_ns_,
                      .missed = report_.missed,
                      .linked = state.linked,
                      .server_ended = state.server_ended,
                      .session = state.sessions,
                      .reading = loop.reading(),
                      .device = loop.device_state(),
                      .sample = loop.sample(),
                      .predicts = state.predict,
                      .force_step = link_.styluses[i].input.front().force.force_step,
                      .demand = loop.demanded(),
                      .state = filter.state(),
                      .counts = loop.counts(),
                      .success_rate = filter.success_rate(),
                      .port_energy = filter.port_energy(),
                      .gain = filter.gain(),
                      .warmth = filter.warmth(),
                      .force = loop.shown(),
                      .torque = loop.shown_torque()});
}

void ServoThread::begin_session(const LinkState& state) noexcept {
  session_ = state.sessions;
  for (ServoLoop& loop : loops_) {
    if (state.predict) {
      loop.predict(state.dt, to_ns(1.0 / settings_.rate));
    } else {
      loop.hold();
    }
  }
}

// Where the contact is solved here.
void ServoThread::end_steps(std::size_t i, std::int64_t now_ns) noexcept {
  ServoLink::Stylus& stylus = link_.styluses[i];
  if (stylus.model.receive() && stylus.model.front().session == session_) {
    loops_[i].receive(stylus.model.front().value, now_ns);
  }
  loops_[i].end_steps(now_ns);
}

void ServoThread::publish_applied(std::size_t i) noexcept {
  ServoLink::Stylus& stylus = link_.styluses[i];
  const AppliedForces* applied = loops_[i].applied();
  if (applied == nullptr) return;
  stylus.applied.back().session = session_;
  stylus.applied.back().value = *applied;
  stylus.applied.publish();
}

void ServoThread::end(ServoEnd end, std::int64_t now_ns) noexcept {
  report_.end = end;
  fade_from_ns_ = now_ns;
  phase_ = Phase::kFading;
}

void ServoThread::fade(std::int64_t now_ns) noexcept {
  const double time = static_cast<double>(now_ns - start_ns_) / kNanosecondsPerSecond;
  const std::int64_t fade_ns = loops_.empty() ? 0 : loops_.front().limits().fade_ns;
  const bool over = now_ns - fade_from_ns_ > fade_ns;
  for (std::size_t i = 0; i < loops_.size(); ++i) {
    if (over) {
      loops_[i].idle(time);
    } else {
      loops_[i].read(time);
      loops_[i].apply(now_ns, ServoInput{});
    }
    write_down(i, now_ns);
  }
  if (over) phase_ = Phase::kOver;
}

ServoEnd ServoThread::run_lockstep() noexcept {
  report_.lockstep = true;
  const double dt = link_.state.front().dt;
  for (std::uint64_t k = 0; !stop_; ++k) {
    step(k);
    const std::int64_t given_ns = monotonic_ns();
    link_.samples_ready.signal();
    if (!wait_for_forces(k)) break;
    report_.round_trip.add(monotonic_ns() - given_ns);
    report_.ticks = k + 1;
    if (finished(static_cast<double>(k + 1) * dt)) return ServoEnd::kFinished;
  }
  return lockstep_end();
}

// Half a step of tolerance: times are sums.
bool ServoThread::finished(double time) noexcept {
  report_.session_time = time;
  return time + 0.5 * link_.state.front().dt > settings_.duration;
}

// The server's steps come with its overruns; between them the servo loops run on.
ServoEnd ServoThread::run_over_link() {
  report_.lockstep = true;
  begin_session(link_.state.front());
  LinkSimulation link(loops_, *settings_.link, link_.state.front().dt, settings_.rate);
  for (std::uint64_t k = 0; !stop_;) {
    bool goes_on = true;
    for (int due = link.run_ticks(); due > 0 && goes_on; --due) {
      goes_on = exchange(link, k);
      if (goes_on) report_.ticks = ++k;
    }
    if (!goes_on) break;
    if (finished(link.time())) return ServoEnd::kFinished;
  }
  return lockstep_end();
}

bool ServoThread::exchange(LinkSimulation& link, std::uint64_t k) {
  for (std::size_t i = 0; i < loops_.size(); ++i) {
    ServoLink::Stylus& stylus = link_.styluses[i];
    stylus.sample.put(link.sample(i, k));
    if (const AppliedForces* applied = link.applied(i)) stylus.applied.put({session_, *applied});
  }
  const std::int64_t given_ns = monotonic_ns();
  link_.samples_ready.signal();
  if (!wait_for_forces(k)) return false;
  report_.round_trip.add(monotonic_ns() - given_ns);
  for (std::size_t i = 0; i < loops_.size(); ++i) {
    ServoLink::Stylus& stylus = link_.styluses[i];
    const bool any = stylus.model.receive() && stylus.model.front().session == session_;
    link.answer(i, stylus.input.front(), any ? &stylus.model.front().value : nullptr);
  }
  return true;
}

// The end of the session is what stops the bridge, and may come together with the stop.
ServoEnd ServoThread::lockstep_end() noexcept {
  link_.state.receive();
  const LinkState& state = link_.state.front();
  if (state.linked && state.sessions == 1) return ServoEnd::kStopped;
  return state.server_ended ? ServoEnd::kServerEnded : ServoEnd::kLinkLost;
}

// Sample k is the state at the end of step k, during which the force of step k-1 is held.
void ServoThread::step(std::uint64_t k) noexcept {
  const double dt = link_.state.front().dt;
  const double begin = static_cast<double>(k) * dt;
  const int ticks = std::max(1, static_cast<int>(std::lround(dt * settings_.rate)));
  for (std::size_t i = 0; i < loops_.size(); ++i) {
    ServoInput input = k > 0 ? link_.styluses[i].input.front() : ServoInput{};
    for (int tick = 0; tick < ticks; ++tick) {
      // On the simulated clock a force is new all through its step.
      input.force.sample_time_ns = to_ns(begin + tick * dt / ticks);
      loops_[i].apply(input.force.sample_time_ns, input);
      loops_[i].read(begin + (tick + 1) * dt / ticks);
    }
    link_.styluses[i].sample.put(loops_[i].take_sample(to_ns(static_cast<double>(k + 1) * dt)));
  }
}

bool ServoThread::wait_for_forces(std::uint64_t k) noexcept {
  constexpr int kForever = -1;
  for (;;) {
    // State before forces: a force that came before the connection broke still counts.
    link_.state.receive();
    const bool linked = link_.state.front().linked && link_.state.front().sessions == 1;
    bool complete = true;
    for (ServoLink::Stylus& stylus : link_.styluses) {
      stylus.input.receive();
      const ServoInput& input = stylus.input.front();
      complete = complete && input.any_force && input.force.sample_sequence == k;
    }
    if (complete) return true;
    if (stop_ || !linked) return false;
    link_.news.wait(kForever);
  }
}

}  // namespace irdm
