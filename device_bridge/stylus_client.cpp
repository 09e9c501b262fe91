#include "device_bridge/stylus_client.hpp"

#include <spdlog/spdlog.h>

#include <cmath>

#include "common/error.hpp"
#include "common/number_text.hpp"
#include "common/realtime/clock.hpp"

namespace irdm {
namespace {

constexpr std::int64_t kOldestForceNs = 50'000'000;

std::int64_t nanoseconds(double seconds) noexcept {
  return std::llround(seconds * kNanosecondsPerSecond);
}

// What a client gave up for is a whole line: where, what, remedy.
Error as_error(const std::string& line) {
  const std::size_t what = line.find(": ");
  const std::size_t remedy = line.rfind("; ");
  if (what == std::string::npos || remedy == std::string::npos || remedy < what) {
    return Error("stylus", line, "connect again");
  }
  return Error(line.substr(0, what), line.substr(what + 2, remedy - what - 2),
               line.substr(remedy + 2));
}

std::shared_ptr<spdlog::logger> no_log() {
  auto log = std::make_shared<spdlog::logger>("irdm");
  log->set_level(spdlog::level::off);
  return log;
}

FilterLimits filter_limits(const BridgeConfig& config) {
  return {.max_force = config.max_force,
          .continuous_force = config.continuous_force,
          .max_torque = config.max_torque,
          .continuous_torque = config.continuous_torque,
          .needed_success = LinkGate::kNeeded,
          .torque_rate = {.rise = config.max_torque_rate, .fall = 4.0 * config.max_torque_rate}};
}

}  // namespace

StylusSettings read_stylus_settings(const std::string& address, TomlTable options) {
  StylusSettings settings;
  settings.bridge.server = parse_server_address(address, "address");
  read_servo_keys(options, settings.bridge);
  settings.lockstep = options.boolean("lockstep", false);
  if (options.has("stylus")) settings.number = options.integer("stylus", 0, 15);
  settings.timeout = options.number("timeout", between(0.05, 3600.0), settings.timeout);
  settings.stale_after = options.number("stale_after", between(0.01, 10.0), settings.stale_after);
  if (settings.lockstep) {
    for (const char* key : {"workspace", "tip"}) {
      if (options.has(key)) options.fail(key, "has no meaning in lockstep", "remove it");
    }
  } else {
    const double farthest = ReadingLimits{}.farthest;
    settings.start.tip = Vector3(options.numbers("tip", 3, between(-farthest, farthest)).data());
    settings.workspace = read_workspace(options.table("workspace"));
  }
  options.finish();
  return settings;
}

ProgramDevice::ProgramDevice(const StylusPose& start, double stale_after)
    : poses_({start, monotonic_ns() - nanoseconds(stale_after) - 1}),
      stale_ns_(nanoseconds(stale_after)) {}

StylusPose ProgramDevice::read(double) noexcept {
  poses_.receive();
  fresh_ = monotonic_ns() - poses_.front().time_ns <= stale_ns_;
  return poses_.front().pose;
}

void StylusClient::Feedback::put(const TickRow& row) noexcept {
  StylusFeedback& out = newest.back();
  out.time_ns = row.time_ns;
  out.linked = row.linked;
  out.fresh = row.device.ready;
  out.filter = row.state;
  out.ready = out.linked && out.fresh &&
              (row.state == FilterState::kArmed || row.state == FilterState::kEngaged);
  out.contact = row.demand.contact;
  out.success_rate = row.success_rate;
  out.gain = row.gain;
  out.force = row.force;
  out.torque = row.torque;
  out.latency = row.demand.any
                    ? kNanosecond * static_cast<double>(row.time_ns - row.demand.sample_time_ns)
                    : std::numeric_limits<double>::quiet_NaN();
  out.ticks = ++ticks;
  out.late_ticks = row.missed;
  out.sessions = row.session;
  newest.publish();
}

StylusClient::StylusClient(const StylusSettings& settings, const Meanwhile& meanwhile)
    : settings_(settings),
      device_(settings.start, settings.stale_after),
      client_(link_, client_settings(), done_) {
  if (!settings_.lockstep) {
    const DeviceMapping mapping{
        .workspace = settings_.workspace,
        .buttons = {.grab = 0, .clutch = ButtonMap::kNone, .reset = 1},
    };
    loops_.emplace_back(device_, filter_limits(settings_.bridge), mapping);
    servo_.emplace(link_, loops_,
                   ServoSettings{.rate = settings_.bridge.rate,
                                 .scheduling = settings_.bridge.realtime,
                                 .duration = device_.duration(),
                                 .log = &feedback_},
                   done_);
  }
  client_.start();
  if (servo_) servo_->start();
  await_session(meanwhile);
}

StylusClient::~StylusClient() {
  if (servo_) servo_->stop();
  client_.stop(true);
}

ClientSettings StylusClient::client_settings() const {
  const BridgeConfig& config = settings_.bridge;
  ClientSettings out{
      .server = *config.server,
      .name = "a program",
      .lockstep = settings_.lockstep,
      .predict = config.predict && !settings_.lockstep,
      .torque = settings_.lockstep || config.max_torque > 0.0,
      .udp = config.udp,
      .connect_timeout_ms = static_cast<int>(std::ceil(1e3 * config.connect_timeout)),
      .scheduling = config.realtime,
      .first_stylus = settings_.number,
      .log = no_log()};
  if (config.key_file) out.key = wire::read_key_file(*config.key_file);
  return out;
}

std::string StylusClient::address() const {
  return address_text(settings_.bridge.server->host, settings_.bridge.server->port);
}

void StylusClient::await_session(const Meanwhile& meanwhile) {
  constexpr int kLookMs = 5;
  const std::int64_t deadline_ns = monotonic_ns() + nanoseconds(settings_.timeout);
  for (;;) {
    const ClientProgress& progress = client_.progress();
    if (progress.gave_up) throw as_error(progress.trouble);
    if (progress.link.sessions > 0) {
      if (progress.link.lockstep == settings_.lockstep) return;
      throw Error(address(), "the server runs in real time",
                  "start it with --lockstep, or connect without lockstep");
    }
    if (monotonic_ns() > deadline_ns) {
      throw Error(address(), progress.trouble.empty() ? "no connection" : progress.trouble,
                  progress.answered ? "the server is there; correct what it refuses"
                                    : "check the address, and start the server first");
    }
    done_.wait(kLookMs);
    if (meanwhile) meanwhile();
  }
}

const char* StylusClient::fault_of(const StylusPose& pose) const noexcept {
  constexpr double kNormTolerance = 1e-6;
  constexpr double kFarthestOnWire = 1000.0;
  const double farthest = settings_.lockstep ? kFarthestOnWire : ReadingLimits{}.farthest;
  for (const double coordinate : pose.tip) {
    if (std::abs(coordinate) <= farthest) continue;  // not where it is not a number
    return settings_.lockstep ? "the tip is not within 1000 m of the origin"
                              : "the tip is not within 2 m of the origin";
  }
  const bool unit = std::abs(pose.orientation.norm() - 1.0) <= kNormTolerance;
  return unit ? nullptr : "the orientation is not a quaternion of length 1";
}

void StylusClient::set(const StylusPose& pose) noexcept {
  device_.set(pose, monotonic_ns());
}

StylusFeedback StylusClient::get() noexcept {
  if (settings_.lockstep) return last_;
  feedback_.newest.receive();
  StylusFeedback out = feedback_.newest.front();
  if (monotonic_ns() - out.time_ns > kOldestForceNs) {
    out.ready = false;
    out.force.setZero();
    out.torque.setZero();
  }
  return out;
}

StylusFeedback StylusClient::step(const StylusPose& pose, const Meanwhile& meanwhile) {
  if (over_) throw Error(address(), "the run is over", "start the server and connect again");
  const double time = static_cast<double>(next_step_ + 1) * dt();
  link_.styluses[0].sample.put({.sequence = next_step_,
                                .time_ns = nanoseconds(time),
                                .buttons = pose.buttons & (kGrabButton | kResetButton),
                                .tip = pose.tip,
                                .orientation = pose.orientation});
  link_.samples_ready.signal();
  try {
    await_force(meanwhile);
  } catch (...) {
    over_ = true;
    last_.ready = last_.linked = false;
    client_.stop(false);
    throw;
  }
  const StylusForce& answer = link_.styluses[0].input.front().force;
  ++next_step_;
  last_ = {.time_ns = answer.sample_time_ns,
           .ready = true,
           .linked = true,
           .fresh = true,
           .filter = FilterState::kEngaged,
           .contact = answer.contact,
           .success_rate = 1.0,
           .force = answer.force,
           .torque = answer.torque,
           .latency = 0.0,
           .ticks = next_step_,
           .sessions = 1};
  return last_;
}

// State before force: one that came before the connection broke still counts.
void StylusClient::await_force(const Meanwhile& meanwhile) {
  constexpr int kLookMs = 50;
  for (;;) {
    link_.state.receive();
    link_.styluses[0].input.receive();
    const ServoInput& input = link_.styluses[0].input.front();
    if (input.any_force && input.force.sample_sequence == next_step_) return;
    const LinkState& state = link_.state.front();
    if (!state.linked || state.sessions != 1) {
      throw Error(
          address(),
          state.server_ended ? "the server has ended the run" : "connection lost in lockstep",
          "start the server and connect again");
    }
    link_.news.wait(kLookMs);
    if (meanwhile) meanwhile();
  }
}

std::string StylusClient::state() {
  const ClientProgress& progress = client_.progress();
  const StylusFeedback now = get();
  if (settings_.lockstep) return over_ || progress.gave_up ? "the run is over" : "ready: lockstep";
  if (progress.gave_up) return progress.trouble;
  if (!progress.link.linked) {
    return "no link: " + (progress.trouble.empty() ? "connection lost" : progress.trouble) +
           "; trying again";
  }
  if (!now.fresh) return "not ready: no pose was set lately (stale_after)";
  switch (now.filter) {
    case FilterState::kFault:
      return "fault: no force any more; connect again";
    case FilterState::kDisarmed:
      return "arming: " + std::to_string(std::lround(100.0 * now.success_rate)) +
             " % of the last ticks were answered in time, " +
             std::to_string(std::lround(100.0 * LinkGate::kNeeded)) + " % are needed";
    case FilterState::kFading:
      return "fading: the newest force is too old";
    case FilterState::kArmed:
    case FilterState::kEngaged:
      break;
  }
  if (now.gain > 0.75) return "ready";
  return "ready: oscillation detected, force scaled to " +
         std::to_string(std::lround(100.0 * now.gain)) + " %";
}

}  // namespace irdm
