#include "server/threads/force_thread.hpp"

#include <algorithm>

#include "common/realtime/clock.hpp"

namespace irdm {
namespace {

StylusCommand to_command(const StylusInput& input) noexcept {
  return {input.present, input.sample.buttons, input.sample.tip, std::nullopt};
}

StylusForce to_answer(const StepRecord& record, const StylusRecord& stylus,
                      const StylusSample& sample) noexcept {
  return {record.force_step, sample.sequence, sample.time_ns,
          stylus.contact,    stylus.force,    stylus.proxy};
}

}  // namespace

ForceThread::ForceThread(Simulation& simulation, NetworkServer& network, StepClock& clock,
                         std::vector<StepSink*> sinks, std::uint64_t steps)
    : simulation_(simulation),
      network_(network),
      clock_(clock),
      sinks_(std::move(sinks)),
      steps_(steps),
      commands_(static_cast<std::size_t>(network.styluses())) {}

ForceThread::~ForceThread() {
  finish();
}

void ForceThread::start(RealTimeScheduling scheduling) {
  thread_ = std::thread([this] { run(); });
  scheduling_ = apply_scheduling(scheduling, thread_, kForcePriority);
}

void ForceThread::finish() {
  if (!thread_.joinable()) return;
  clock_.stop();
  thread_.join();
}

void ForceThread::run() noexcept {
  while ((steps_ == 0 || report_.steps < steps_) && clock_.wait(report_.steps)) {
    const std::int64_t begin = monotonic_ns();
    step();
    const std::int64_t end = monotonic_ns();
    report_.step_time.add(end - begin);
    ++report_.steps;
    watch_health(begin, end);
  }
  finished_.signal();
}

void ForceThread::watch_health(std::int64_t begin_ns, std::int64_t end_ns) noexcept {
  if (report_.steps == 1) window_begin_ns_ = begin_ns;
  window_.step_time.add(end_ns - begin_ns);
  if (clock_.last_delay() >= 0) window_.wakeup_delay.add(clock_.last_delay());
  if (end_ns - window_begin_ns_ < kHealthPeriodNs) return;
  window_.steps = report_.steps;
  window_.resets = report_.resets;
  window_.unsolved = report_.unsolved;
  window_.missed = clock_.missed();
  health_.put(window_);  // some 10 kB, once a second
  window_ = ForceHealth{};
  window_begin_ns_ = end_ns;
}

void ForceThread::step() noexcept {
  for (std::size_t s = 0; s < commands_.size(); ++s) {
    StylusPort& port = network_.port(static_cast<int>(s));
    port.in.receive();
    commands_[s] = to_command(port.in.front());
  }
  const bool put_back = reset_requested_.load(std::memory_order_relaxed) &&
                        reset_requested_.exchange(false, std::memory_order_relaxed);
  simulation_.step(commands_, record_, put_back);
  if (record_.reset) ++report_.resets;
  for (std::size_t s = 0; s < commands_.size(); ++s) {
    if (!commands_[s].present) continue;
    StylusPort& port = network_.port(static_cast<int>(s));
    port.out.put(to_answer(record_, record_.stylus[s], port.in.front().sample));
    report_.peak_force = std::max(report_.peak_force, record_.stylus[s].force.norm());
  }
  network_.forces_ready().signal();
  for (int i = 0; i < record_.object_count; ++i) {
    if (!record_.object[static_cast<std::size_t>(i)].solved) ++report_.unsolved;
  }
  for (StepSink* sink : sinks_) sink->put(record_);
}

}  // namespace irdm
