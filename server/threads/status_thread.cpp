#include "server/threads/status_thread.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <utility>

#include "common/realtime/clock.hpp"

namespace irdm {
namespace {

constexpr int kStatusPeriodMs = 1000;

wire::Quantiles quantiles(const Histogram& histogram) {
  const auto microseconds = [](std::int64_t ns) { return static_cast<float>(ns) / 1000.0F; };
  return {microseconds(histogram.percentile(0.5)), microseconds(histogram.percentile(0.99)),
          microseconds(histogram.maximum())};
}

void put(std::ostringstream& text, const char* name, const wire::Quantiles& value) {
  text << ", " << name << " p50 " << value.median << ", p99 " << value.p99 << ", max "
       << value.maximum << " us";
}

}  // namespace

StatusThread::StatusThread(const Parts& parts, double log_period)
    : parts_(parts), log_period_ns_(std::llround(kNanosecondsPerSecond * log_period)) {}

StatusThread::~StatusThread() {
  finish();
}

void StatusThread::start() {
  gathered_ns_ = monotonic_ns();
  thread_ = std::thread([this] { run(); });
}

void StatusThread::finish() {
  if (!thread_.joinable()) return;
  stop_.signal();
  thread_.join();
}

void StatusThread::run() {
  std::int64_t logged_ns = monotonic_ns();
  while (!stop_.wait(kStatusPeriodMs)) {
    const wire::Status status = gather();
    parts_.network.status().put(status);
    log_prediction_period();
    log_withheld();
    log_faults();
    if (log_period_ns_ == 0 || gathered_ns_ - logged_ns < log_period_ns_) continue;
    logged_ns = gathered_ns_;
    spdlog::info("{}", status_line(status, parts_.network.stats(),
                                   parts_.force.status().front().cache_misses));
  }
}

wire::Status StatusThread::gather() {
  parts_.force.status().receive();
  const ForceHealth& force = parts_.force.status().front();
  wire::Status status;
  status.steps = force.steps;
  status.missed = force.missed;
  status.unsolved = force.unsolved;
  status.overflows = parts_.deformation.lost_steps();
  if (parts_.recorder != nullptr) status.overflows += parts_.recorder->lost();
  status.step_time = quantiles(force.step_time);
  status.wakeup_delay = quantiles(force.wakeup_delay);
  status.surface_rate = surface_rate();
  return status;
}

void StatusThread::log_prediction_period() {
  const int period = parts_.force.status().front().prediction_period;
  if (period == std::exchange(prediction_period_, period)) return;
  if (period == 1) {
    spdlog::info("a contact model in each step again");
  } else {
    spdlog::warn(
        "steps take longer than dt: a contact model only every {} steps; use fewer modes "
        "(modes.error), a coarser mesh or a larger response.dt",
        period);
  }
}

void StatusThread::log_withheld() {
  const std::uint64_t withheld = parts_.force.status().front().withheld;
  if (withheld == std::exchange(withheld_, withheld)) return;
  spdlog::warn("{}", withheld_line(withheld));
}

void StatusThread::log_faults() {
  const ForceHealth& health = parts_.force.status().front();
  for (std::size_t s = 0; s < faults_.size(); ++s) {
    const StylusFaults now = health.faults[s];
    const StylusFaults before = std::exchange(faults_[s], now);
    for (const std::string& line : fault_lines(s, before, now)) spdlog::warn("{}", line);
  }
}

// Since the last time.
float StatusThread::surface_rate() {
  const std::int64_t now_ns = monotonic_ns();
  const std::uint64_t frames = parts_.deformation.frames();
  const double rate = kNanosecondsPerSecond * static_cast<double>(frames - frames_) /
                      static_cast<double>(std::max<std::int64_t>(1, now_ns - gathered_ns_));
  frames_ = frames;
  gathered_ns_ = now_ns;
  return static_cast<float>(rate);
}

std::string withheld_line(std::uint64_t steps) {
  return "force withheld in " + std::to_string(steps) +
         " steps: server late; use fewer modes (modes.error), a coarser mesh or a larger "
         "response.dt";
}

std::vector<std::string> fault_lines(std::size_t s, const StylusFaults& before,
                                     const StylusFaults& now) {
  std::vector<std::string> lines;
  const std::string stylus = "stylus " + std::to_string(s) + ": ";
  if (now.outside > before.outside) {
    lines.push_back(stylus + "positions beyond world.bound in " + std::to_string(now.outside) +
                    " steps so far: not used, its force fades");
  }
  if (now.disagreed > before.disagreed) {
    lines.push_back(stylus + std::to_string(now.disagreed) +
                    " forces so far are not where its own samples are: it exerts nothing");
  }
  return lines;
}

std::string status_line(const wire::Status& status, const NetworkStats& network,
                        std::uint64_t cache_misses) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(1) << "status: " << status.steps << " steps";
  put(text, "step", status.step_time);
  put(text, "wake-up", status.wakeup_delay);
  text << ", overruns " << status.missed << ", lost in full queues " << status.overflows
       << ", unsolved " << status.unsolved << ", " << status.surface_rate
       << " surfaces/s, sessions " << network.accepted;
  const auto count = [&text](const char* name, std::uint64_t value) {
    if (value > 0) text << ", " << name << ' ' << value;
  };
  count("column cache misses", cache_misses);
  count("refused", network.refused);
  count("cut before Hello", network.displaced);
  count("without the key", network.wrong_keys);
  count("protocol errors", network.protocol_errors);
  count("silent", network.timeouts);
  count("forces replaced", network.forces_replaced);
  count("datagrams dropped",
        network.datagrams_foreign + network.datagrams_forged + network.datagrams_replayed);
  return text.str();
}

}  // namespace irdm
