#include "device_bridge/bridge.hpp"

#include <spdlog/spdlog.h>
#include <algorithm>
#include <cmath>
#include <iomanip>
#include <memory>
#include <optional>
#include <sstream>
#include <vector>

#include "common/blackbox/frame_log.hpp"
#include "common/error.hpp"
#include "common/number_text.hpp"
#include "common/realtime/clock.hpp"
#include "common/realtime/scheduling.hpp"
#include "device_bridge/blackbox/tick_log.hpp"
#include "device_bridge/commission/allowance.hpp"
#include "device_bridge/device_registry.hpp"
#include "device_bridge/network_client.hpp"
#include "device_bridge/servo_link.hpp"
#include "device_bridge/servo_loop.hpp"
#include "device_bridge/servo_thread.hpp"

namespace irdm {
namespace {

std::string percentiles_text(const Histogram& histogram) {
  if (histogram.count() == 0) return "none";
  const auto ms = [](std::int64_t ns) {
    return static_cast<double>(ns) / static_cast<double>(kNanosecondsPerMillisecond);
  };
  std::ostringstream text;
  text << std::fixed << std::setprecision(3) << "p50 " << ms(histogram.percentile(0.5)) << ", p90 "
       << ms(histogram.percentile(0.9)) << ", p99 " << ms(histogram.percentile(0.99)) << ", max "
       << ms(histogram.maximum()) << " ms";
  return text.str();
}

}  // namespace

std::string to_text(const BridgeReport& report) {
  const auto& [servo, client, scheduling, styluses, peak_force, impulse, peak_torque, filter,
               device_fault, withheld] = report;
  const std::uint64_t reconnects = client.sessions > 0 ? client.sessions - 1 : 0;
  std::ostringstream text;
  text << std::fixed << std::setprecision(3);
  text << "session: " << servo.session_time << " s " << (servo.lockstep ? "lockstep" : "real time")
       << ", styluses " << styluses << ", sessions " << client.sessions << ", reconnects "
       << reconnects << ", protocol errors " << client.protocol_errors << ", stalls "
       << client.stalls << '\n';
  text << "samples: " << client.samples << " sent\n";
  text << "forces: " << client.forces << " received, " << client.gaps << " gaps, "
       << client.steps_missed << " steps missed, longest gap " << client.longest_gap << ", "
       << client.forces_old << " dropped\n";
  if (client.models + client.models_refused > 0) {
    text << "contact models: " << client.models << " used, " << client.models_refused
         << " invalid\n";
  }
  if (client.datagram_sessions > 0) {
    text << "datagrams: " << client.datagrams << " received in " << client.datagram_sessions
         << " sessions, " << client.datagrams_dropped << " dropped\n";
  }
  text << "round trip: " << percentiles_text(servo.lockstep ? servo.round_trip : client.round_trip)
       << '\n';
  if (servo.lockstep) {
    text << "servo: " << servo.ticks << " steps\n";
  } else {
    text << "servo: " << servo.ticks << " ticks, " << servo.missed << " missed, wake-up "
         << percentiles_text(servo.wakeup) << ", scheduling " << scheduling << '\n';
  }
  text << "peak force: " << peak_force << " N, impulse " << impulse << " N s";
  if (peak_torque > 0.0) text << ", peak torque " << peak_torque << " N m";
  text << "; safety filter: " << filter.demands << " forces and " << filter.readings
       << " readings not used, force dropped " << filter.trips << " times, faults " << filter.faults
       << '\n';
  if (withheld > 0) text << "force withheld in " << withheld << " steps: server late\n";
  return text.str();
}

namespace {

/// Devices that are open, and closed again whatever happens.
class OpenDevices {
 public:
  explicit OpenDevices(const std::vector<DeviceConfig>& configs) {
    for (const DeviceConfig& config : configs) made_.push_back(make_device(config));
    for (const auto& device : made_) {
      device->open();
      ++open_;
    }
  }
  OpenDevices(const OpenDevices&) = delete;
  OpenDevices& operator=(const OpenDevices&) = delete;
  ~OpenDevices() {
    for (std::size_t i = 0; i < open_; ++i) made_[i]->close();
  }
  const std::vector<std::unique_ptr<HapticDevice>>& all() const noexcept { return made_; }

 private:
  std::vector<std::unique_ptr<HapticDevice>> made_;
  std::size_t open_ = 0;
};

/// What a bridge leaves when something went wrong.
class BridgeBlackBox {
 public:
  explicit BridgeBlackBox(const BlackBoxSettings& settings) {
    if (!settings.folder.empty()) box_.emplace(settings, "irdm-bridge", parts());
  }
  TickLog* ticks() noexcept { return box_ ? &ticks_ : nullptr; }
  FrameLog* frames() noexcept { return box_ ? &frames_ : nullptr; }
  void start() {
    if (box_) box_->start();
  }
  void report(const std::string& fault) {
    if (box_) box_->report(fault, "");
  }
  /// When servo and network thread have ended.
  void finish() {
    if (box_) box_->finish();
  }

 private:
  std::vector<BlackBoxPart*> parts() { return {&ticks_, &frames_}; }

  TickLog ticks_;
  FrameLog frames_;
  std::optional<BlackBox> box_;
};

// The same, and no more than its commissioning allows.
FilterLimits allowed_limits(const HapticDevice& device, const BridgeConfig& config,
                            const DeviceConfig& table) {
  FilterLimits limits = filter_limits(device, config);
  const commission::Allowance allowed = commission::allowance(table, device, limits.max_force);
  if (!allowed.words.empty()) spdlog::warn("{}", allowed.words);
  limits.max_force = std::min(limits.max_force, allowed.force);
  limits.max_torque = std::min(limits.max_torque, allowed.torque);
  if (table.commissioned) {
    const double noise = table.commissioned->measured.position_noise.value_or(0.0);
    limits.reading.resolution = std::max(limits.reading.resolution, kNoiseSteps * noise);
  }
  limits.needed_success = LinkGate::kNeeded;
  return limits;
}

/// Whether there has been no session for all of the time that the bridge should run.
class SessionWatch {
 public:
  /// @param duration [s]
  SessionWatch(NetworkClient& client, double duration) : client_(client), duration_(duration) {}

  bool over() noexcept {
    began_ = began_ || client_.progress().link.sessions > 0;
    const auto waited = static_cast<double>(monotonic_ns() - start_ns_);
    return !began_ && waited * kNanosecond > duration_;
  }
  /// Why; empty: there was one.
  std::string failure(const ServerAddress& server) const {
    if (began_) return {};
    return address_text(server.host, server.port) + ": no session in " + number_text(duration_) +
           " s: " + client_.progress().trouble +
           (client_.progress().answered ? "" : "; start irdm-server there, or correct --server");
  }

 private:
  NetworkClient& client_;
  double duration_;
  std::int64_t start_ns_ = monotonic_ns();
  bool began_ = false;
};

/// Tells a person whose press of a button is awaited before there is force. Main thread.
class ArmingNotes {
 public:
  explicit ArmingNotes(const std::vector<ServoLink::Stylus>& styluses)
      : styluses_(styluses), awaited_(styluses.size(), false) {}

  void look() {
    for (std::size_t i = 0; i < styluses_.size(); ++i) {
      const bool awaited = styluses_[i].awaits_button;
      if (awaited && !awaited_[i]) {
        spdlog::info("stylus {}: no force until one of its buttons is pressed (arm = \"button\")",
                     i);
      }
      awaited_[i] = awaited;
    }
  }

 private:
  const std::vector<ServoLink::Stylus>& styluses_;
  std::vector<bool> awaited_;
};

// Until a signal comes, a thread of ours ends, a driver stops making ticks, or it is too late for a
// session.
void await_end(StopSignal& stop_signal, EventFd& done, const ServoThread& servo, DeviceWatch& watch,
               SessionWatch& session, ArmingNotes& arming) {
  constexpr int kLookMs = 100;
  constexpr int kSilentLooks = 3;  // one is seen by a process that was itself asleep
  int silent = 0;
  while (!stop_signal.wait_for(kLookMs, done.descriptor()) && !done.consume() &&
         silent < kSilentLooks && !session.over()) {
    watch.look();
    arming.look();
    silent = servo.driver_silent(monotonic_ns()) ? silent + 1 : 0;
  }
  watch.look();
}

std::string failure_of(ServoEnd end, const DeviceWatch& watch) {
  if (end == ServoEnd::kLinkLost) {
    return "server: connection lost in lockstep; start both programs again";
  }
  if (end == ServoEnd::kDeviceLost) return watch.troubles();
  if (end == ServoEnd::kDriverStuck) {
    return "device: its driver no longer makes ticks; check power and cable, and start again";
  }
  return {};
}

}  // namespace

FilterLimits filter_limits(const HapticDevice& device, const BridgeConfig& config) {
  const DeviceRating rating = device.rating();
  return {.max_force = std::min(config.max_force, rating.peak),
          .continuous_force = std::min(config.continuous_force, rating.continuous),
          .max_torque = std::min(config.max_torque, rating.peak_torque),
          .continuous_torque = std::min(config.continuous_torque, rating.continuous_torque),
          .reading = {.resolution = rating.resolution},
          .torque_rate = {.rise = config.max_torque_rate, .fall = 4.0 * config.max_torque_rate}};
}

ClientSettings client_settings(const BridgeConfig& config) {
  ClientSettings settings{
      .server = *config.server,
      .predict = config.predict,
      .simulated_link = config.link.has_value(),
      .udp = config.udp,
      .connect_timeout_ms = static_cast<int>(std::ceil(1e3 * config.connect_timeout)),
      .scheduling = config.realtime};
  if (config.key_file) settings.key = wire::read_key_file(*config.key_file);
  return settings;
}

BridgeReport run_bridge(const BridgeConfig& config, StopSignal& stop_signal, double duration) {
  if (!config.server) {
    throw Error("bridge", "no server is named", "give --server HOST:PORT or the key bridge.server");
  }
  const OpenDevices devices(config.devices);
  std::vector<ServoLoop> loops;
  double longest = 0.0;
  bool simulated = true;
  bool torque = false;
  for (const auto& device : devices.all()) {
    const FilterLimits limits = allowed_limits(*device, config, config.devices[loops.size()]);
    loops.emplace_back(*device, limits, config.devices[loops.size()].mapping, config.arm_by_button);
    longest = std::max(longest, device->duration());
    simulated = simulated && device->simulated();
    torque = torque || limits.max_torque > 0.0;
  }

  if (config.link && !simulated) {
    throw Error("bridge.link", "is simulated, and a device is not",
                "use virtual devices, or remove the table");
  }
  EventFd done;
  ServoLink link(loops.size());
  ClientSettings settings = client_settings(config);
  settings.lockstep = simulated;
  settings.torque = torque;
  BridgeBlackBox black_box(config.black_box);
  settings.tap = black_box.frames();
  NetworkClient client(link, settings, done);
  ServoThread servo(link, loops,
                    {.rate = config.rate,
                     .scheduling = config.realtime,
                     .duration = std::min(duration, longest),
                     .link = config.link,
                     .log = black_box.ticks()},
                    done);
  const std::string memory = lock_memory(config.realtime);
  black_box.start();
  client.start();
  servo.start();
  DeviceWatch watch(devices.all());
  SessionWatch session(client, duration);
  ArmingNotes arming(link.styluses);
  await_end(stop_signal, done, servo, watch, session, arming);
  const std::string no_session = session.over() ? session.failure(*config.server) : "";
  if (servo.driver_silent(monotonic_ns())) black_box.report("the device's driver makes no ticks");
  servo.stop();
  client.stop(servo.report().end == ServoEnd::kFinished);
  black_box.finish();

  BridgeReport report{.servo = servo.report(),
                      .client = client.report(),
                      .scheduling = servo.scheduling() + ", memory " + memory,
                      .styluses = static_cast<int>(loops.size())};
  for (const ServoLoop& loop : loops) {
    report.peak_force = std::max(report.peak_force, loop.peak_force());
    report.impulse += loop.impulse();
    report.peak_torque = std::max(report.peak_torque, loop.peak_torque());
    report.withheld += loop.withheld();
    const FilterCounts counts = loop.counts();
    report.filter.readings += counts.readings;
    report.filter.demands += counts.demands;
    report.filter.trips += counts.trips;
    report.filter.faults += counts.faults;
  }
  report.device_fault =
      report.servo.end == ServoEnd::kDeviceLost || report.servo.end == ServoEnd::kDriverStuck;
  if (report.device_fault || report.client.failure.empty()) {
    report.client.failure = failure_of(report.servo.end, watch);
  }
  if (report.client.failure.empty()) report.client.failure = no_session;
  return report;
}

}  // namespace irdm
