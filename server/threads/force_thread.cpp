#include "server/threads/force_thread.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/realtime/clock.hpp"
#include "common/realtime/real_time_scope.hpp"

namespace irdm {
namespace {

StylusCommand to_command(const StylusInput& input) noexcept {
  StylusCommand command{input.present, input.sample.buttons, input.sample.tip, std::nullopt};
  command.orientation = input.sample.orientation;
  return command;
}

StylusForce to_answer(const StepRecord& record, const StylusRecord& stylus,
                      const StylusSample& sample) noexcept {
  return {record.force_step, sample.sequence, sample.time_ns, stylus.contact,
          stylus.force,      stylus.proxy,    stylus.torque};
}

}  // namespace

ForceThread::ForceThread(Simulation& simulation, NetworkServer& network, RunControl& control,
                         StepClock& clock, std::vector<StepSink*> sinks, std::uint64_t steps)
    : simulation_(simulation),
      network_(network),
      control_(control),
      clock_(clock),
      sinks_(std::move(sinks)),
      steps_(steps),
      outside_(static_cast<std::size_t>(network.styluses())),
      turns_(simulation.dt()),
      commands_(static_cast<std::size_t>(network.styluses())) {
  for (std::size_t s = 0; s < commands_.size(); ++s) bridged_.emplace_back(simulation, s);
  report_.faults.resize(commands_.size());
}

void ForceThread::add_viewer_stylus(const ViewerStylus& stylus) {
  viewer_stylus_ = stylus;
  commands_.resize(static_cast<std::size_t>(network_.styluses()) + 1);
}

ForceThread::~ForceThread() {
  finish();
}

void ForceThread::start(RealTimeScheduling scheduling) {
  thread_ = std::thread([this, scheduling] {
    const RealTimeScope scope("force", scheduling);
    run();
  });
  scheduling_ = apply_scheduling(scheduling, thread_, kForcePriority);
}

void ForceThread::finish() {
  if (!thread_.joinable()) return;
  clock_.stop();
  thread_.join();
}

void ForceThread::run() noexcept {
  while ((steps_ == 0 || report_.steps < steps_) && clock_.wait(report_.steps)) {
    if (!control_.take_step()) {
      fade_while_paused();
      continue;
    }
    const std::int64_t begin = monotonic_ns();
    step();
    const std::int64_t end = monotonic_ns();
    report_.step_time.add(end - begin);
    ++report_.steps;
    watch_health(begin, end);
    write_down(begin, end);
  }
  for (const BridgedStylus& stylus : bridged_) {
    report_.late += stylus.late();
    report_.lost += stylus.lost();
    report_.bounded += stylus.bounded();
    report_.withheld += stylus.withheld();
  }
  for (std::size_t s = 0; s < bridged_.size(); ++s) report_.faults[s] = faults(s);
  report_.limited = simulation_.limited();
  report_.cache_misses = simulation_.cache_misses();
  finished_.signal();
}

// For the black box.
void ForceThread::write_down(std::int64_t begin_ns, std::int64_t end_ns) noexcept {
  if (log_ == nullptr) return;
  StepRow row{.time_ns = begin_ns,
              .late_ns = std::max<std::int64_t>(clock_.last_delay(), 0),
              .duration_ns = end_ns - begin_ns,
              .force_step = record_.force_step,
              .missed = clock_.missed(),
              .continued = continued_,
              .reset = record_.reset,
              .stylus_count = static_cast<int>(commands_.size())};
  for (int i = 0; i < record_.object_count; ++i) {
    const ObjectRecord& object = record_.object[static_cast<std::size_t>(i)];
    row.solved = row.solved && object.solved;
    row.residual = std::max(row.residual, object.residual);
  }
  for (std::size_t s = 0; s < commands_.size(); ++s) {
    const StylusRecord& stylus = record_.stylus[s];
    StepRow::Stylus& kept = row.stylus[s];
    kept.present = stylus.present;
    kept.buttons = stylus.buttons;
    kept.object = stylus.object;
    kept.contact = stylus.contact;
    kept.tip = stylus.tip;
    kept.proxy = stylus.proxy;
    kept.force = stylus.force;
    if (s >= bridged_.size()) {
      kept.left = !stylus.present;  // a viewer's mouse comes and goes
      continue;
    }
    const StylusInput& input = network_.port(static_cast<int>(s)).in.front();
    kept.left = input.left;
    kept.predicts = input.predicts;
    kept.sequence = input.sample.sequence;
    kept.sample_time_ns = input.sample.time_ns;
  }
  log_->put(row);
}

void ForceThread::watch_health(std::int64_t begin_ns, std::int64_t end_ns) noexcept {
  if (report_.steps == 1) window_begin_ns_ = begin_ns;
  window_.step_time.add(end_ns - begin_ns);
  // In lockstep nobody waits for a deadline, and the models do not depend on the machine.
  const double dt_ns = kNanosecondsPerSecond * simulation_.dt();
  const bool overlong = static_cast<double>(end_ns - begin_ns) > dt_ns;
  overlong_ += overlong && !clock_.lockstep() ? 1 : 0;
  if (clock_.last_delay() >= 0) window_.wakeup_delay.add(clock_.last_delay());
  if (end_ns - window_begin_ns_ < kHealthPeriodNs) return;
  window_.steps = report_.steps;
  window_.resets = report_.resets;
  window_.unsolved = report_.unsolved;
  window_.missed = clock_.missed();
  window_.cache_misses = simulation_.cache_misses();
  for (std::size_t s = 0; s < bridged_.size(); ++s) {
    window_.withheld += bridged_[s].withheld();
    window_.faults[s] = faults(s);
  }
  throttle_.update(report_.steps - std::exchange(steps_before_, report_.steps),
                   std::exchange(overlong_, 0));
  window_.prediction_period = throttle_.period();
  health_.put(window_);  // some 10 kB each, once a second
  status_.put(window_);
  window_ = ForceHealth{};
  window_begin_ns_ = end_ns;
}

StylusFaults ForceThread::faults(std::size_t s) const noexcept {
  return {outside_[s].steps_in_all, bridged_[s].disagreed()};
}

StylusRecord ForceThread::faded(const StylusRecord& last, std::uint64_t steps,
                                const Vector3& tip) const noexcept {
  const double left = std::max(0.0, 1.0 - static_cast<double>(steps) * simulation_.dt() / kFade);
  StylusRecord fading = last;
  fading.force *= left;
  fading.torque *= left;
  if (left == 0.0 || !fading.present) {
    fading = StylusRecord{};
    fading.proxy = tip;
  }
  return fading;
}

// A bridge that solves the contact lets its force fade.
void ForceThread::fade_model(StylusPort& port) noexcept {
  if (!port.in.front().predicts) return;
  port.model.back().session = port.in.front().session;
  port.model.back().value.valid = false;
  port.model.back().value.paused = true;
  port.model.publish();
}

StylusRecord ForceThread::bounded(std::size_t s, const StylusRecord& stylus) const noexcept {
  const double most = simulation_.max_force(s);
  const double force = stylus.force.norm();
  if (!(force > most)) return stylus;
  StylusRecord bounded = stylus;
  bounded.force *= most / force;
  bounded.torque *= most / force;
  return bounded;
}

// What is commanded to any stylus is bounded here, whatever objects and other hands did.
void ForceThread::answer(std::size_t s, const StylusRecord& stylus) noexcept {
  StylusPort& port = network_.port(static_cast<int>(s));
  port.out.put(to_answer(record_, bounded(s, stylus), port.in.front().sample));
}

// A hand feels nothing meanwhile: what it felt fades.
void ForceThread::fade_while_paused() noexcept {
  paused_steps_ = was_paused_ ? paused_steps_ + 1 : 1;
  was_paused_ = true;
  clock_.rest();
  if (clock_.lockstep()) return;  // the bridges wait
  const std::size_t bridges = static_cast<std::size_t>(network_.styluses());
  for (std::size_t s = 0; s < bridges; ++s) {
    StylusPort& port = network_.port(static_cast<int>(s));
    port.in.receive();
    if (!port.in.front().present) continue;
    answer(s, faded(bounded(s, record_.stylus[s]), paused_steps_, port.in.front().sample.tip));
    fade_model(port);
  }
  network_.forces_ready().signal();
}

// A sample from beyond the bound is not used: its stylus takes no part where it was last.
void ForceThread::check_position(std::size_t s) noexcept {
  StylusCommand& command = commands_[s];
  Outside& outside = outside_[s];
  if (!command.present || command.tip.cwiseAbs().maxCoeff() <= position_bound_) {
    outside.steps = 0;
    return;
  }
  if (outside.steps++ == 0) outside.last = bounded(s, record_.stylus[s]);
  ++outside.steps_in_all;
  command.present = false;
  command.tip = outside.last.tip;
}

void ForceThread::take_commands() noexcept {
  const std::size_t bridges = static_cast<std::size_t>(network_.styluses());
  for (std::size_t s = 0; s < bridges; ++s) {
    StylusPort& port = network_.port(static_cast<int>(s));
    port.in.receive();
    commands_[s] = to_command(port.in.front());
    check_position(s);
    // Who feels nothing has to come from outside again; a step without it makes it so.
    if (was_paused_ && !clock_.lockstep()) commands_[s].present = false;
    port.applied.receive();
    const std::uint64_t session = port.in.front().predicts ? port.in.front().session : 0;
    commands_[s] = bridged_[s].next(commands_[s], session, port.applied.front());
  }
  continued_ = was_paused_;
  if (!control_.paused()) was_paused_ = false;
  if (!viewer_stylus_) return;
  control_.stylus().receive();
  commands_[bridges] =
      viewer_stylus_->next(to_command(control_.stylus().front()), record_.stylus[bridges]);
}

void ForceThread::step() noexcept {
  take_commands();
  if (const Settings* settings = control_.take_settings()) simulation_.set(*settings);
  simulation_.step(commands_, record_, control_.take_reset());
  if (record_.reset) ++report_.resets;
  const std::size_t bridges = static_cast<std::size_t>(network_.styluses());
  for (std::size_t s = 0; s < commands_.size(); ++s) {
    report_.peak_force = std::max(report_.peak_force, record_.stylus[s].force.norm());
    if (s >= bridges) continue;
    // A sample is answered, also where its stylus takes no part in this step.
    StylusPort& port = network_.port(static_cast<int>(s));
    if (!port.in.front().present) continue;
    const Outside& outside = outside_[s];
    if (outside.steps == 0) {
      answer(s, record_.stylus[s]);
    } else {
      answer(s, faded(outside.last, outside.steps, outside.last.tip));
      fade_model(port);
    }
  }
  network_.forces_ready().signal();
  for (int i = 0; i < record_.object_count; ++i) {
    if (!record_.object[static_cast<std::size_t>(i)].solved) ++report_.unsolved;
  }
  for (StepSink* sink : sinks_) sink->put(record_);
  predict_horizon();
}

// After all else: who waits for a force has it by now.
void ForceThread::predict_horizon() noexcept {
  if (!throttle_.due(clock_.behind())) return;
  const std::int64_t begin = monotonic_ns();
  bool tried = false;
  bool any = false;
  turns_.step(bridged_.size(), [&](std::size_t s, int& budget) {
    StylusPort& port = network_.port(static_cast<int>(s));
    if (!commands_[s].present || !port.in.front().predicts) return false;
    tried = true;
    port.model.back().session = port.in.front().session;
    if (!bridged_[s].predict_horizon(port.model.back().value, budget)) return false;
    port.model.publish();
    any = true;
    return true;
  });
  if (any) network_.forces_ready().signal();
  if (tried) report_.prediction_time.add(monotonic_ns() - begin);
}

}  // namespace irdm
