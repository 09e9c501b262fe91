#include "device_bridge/servo_thread.hpp"

#include <algorithm>
#include <cmath>

#include "common/realtime/clock.hpp"

namespace irdm {
namespace {

constexpr double kNanosecondsPerSecond = 1e9;

std::int64_t to_ns(double seconds) noexcept {
  return std::llround(seconds * kNanosecondsPerSecond);
}

}  // namespace

ServoThread::ServoThread(ServoLink& link, std::vector<ServoLoop>& loops,
                         const ServoSettings& settings, Wakeup& done)
    : link_(link), loops_(loops), settings_(settings), done_(done) {}

ServoThread::~ServoThread() {
  stop();
}

void ServoThread::start() {
  thread_ = std::thread([this] { run(); });
  scheduling_ = apply_scheduling(settings_.scheduling, thread_, kServoPriority);
}

void ServoThread::stop() {
  if (!thread_.joinable()) return;
  stop_ = true;
  link_.news.signal();
  thread_.join();
}

void ServoThread::run() noexcept {
  report_.end = run_real_time();
  for (ServoLoop& loop : loops_) loop.rest();
  done_.signal();
}

ServoEnd ServoThread::run_real_time() noexcept {
  const std::int64_t period_ns = to_ns(1.0 / settings_.rate);
  PeriodicSchedule schedule(monotonic_ns(), period_ns);
  std::int64_t start_ns = 0;  // of the session's time; 0: no session yet
  ServoEnd end = ServoEnd::kStopped;
  for (ServoLoop& loop : loops_) loop.rest();
  while (!stop_) {
    const std::int64_t deadline_ns = schedule.next(monotonic_ns());
    sleep_until(deadline_ns);
    const std::int64_t now_ns = monotonic_ns();
    report_.wakeup.add(now_ns - deadline_ns);
    report_.missed = schedule.missed();
    link_.state.receive();
    const LinkState& state = link_.state.front();
    if (state.sessions == 0) continue;
    if (start_ns == 0) {
      for (ServoLoop& loop : loops_) loop.restart(!state.lockstep);
      if (state.lockstep) return run_lockstep();
      start_ns = now_ns;
    }
    tick(now_ns, start_ns);
    if (report_.session_time >= settings_.duration) {
      end = ServoEnd::kFinished;
      break;
    }
  }
  if (start_ns != 0) fade_out();
  return end;
}

void ServoThread::tick(std::int64_t now_ns, std::int64_t start_ns) noexcept {
  ++report_.ticks;
  report_.session_time = static_cast<double>(now_ns - start_ns) / kNanosecondsPerSecond;
  for (std::size_t i = 0; i < loops_.size(); ++i) {
    loops_[i].read(report_.session_time);
    link_.styluses[i].sample.put(loops_[i].take_sample(now_ns));
    link_.styluses[i].input.receive();
    loops_[i].apply(now_ns, link_.styluses[i].input.front());
    const SafetyFilter& filter = loops_[i].filter();
    link_.styluses[i].armed = filter.state() != FilterState::kDisarmed;
    link_.styluses[i].success_rate = filter.success_rate();
  }
  link_.samples_ready.signal();
}

void ServoThread::fade_out() noexcept {
  const std::int64_t period_ns = to_ns(1.0 / settings_.rate);
  const std::int64_t begin_ns = monotonic_ns();
  PeriodicSchedule schedule(begin_ns, period_ns);
  const ServoInput lost;
  const std::int64_t fade_ns = loops_.empty() ? 0 : loops_.front().limits().fade_ns;
  for (std::int64_t now_ns = begin_ns; now_ns - begin_ns <= fade_ns; now_ns = monotonic_ns()) {
    for (ServoLoop& loop : loops_) loop.apply(now_ns, lost);
    sleep_until(schedule.next(now_ns));
  }
}

ServoEnd ServoThread::run_lockstep() noexcept {
  report_.lockstep = true;
  const double dt = link_.state.front().dt;
  for (std::uint64_t k = 0; !stop_; ++k) {
    step(k);
    const std::int64_t given_ns = monotonic_ns();
    link_.samples_ready.signal();
    if (!wait_for_forces(k)) {
      if (stop_) break;
      return link_.state.front().server_ended ? ServoEnd::kServerEnded : ServoEnd::kLinkLost;
    }
    report_.round_trip.add(monotonic_ns() - given_ns);
    report_.ticks = k + 1;
    report_.session_time = static_cast<double>(k + 1) * dt;
    // Half a step of tolerance: the product above is rounded.
    if (report_.session_time + 0.5 * dt > settings_.duration) return ServoEnd::kFinished;
  }
  return ServoEnd::kStopped;
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
