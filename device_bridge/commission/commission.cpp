#include "device_bridge/commission/commission.hpp"

#include <ctime>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "common/error.hpp"
#include "common/realtime/clock.hpp"
#include "common/realtime/scheduling.hpp"
#include "device_bridge/bridge.hpp"
#include "device_bridge/commission/force_steps.hpp"
#include "device_bridge/commission/kill_step.hpp"
#include "device_bridge/commission/plan.hpp"
#include "device_bridge/commission/step_runner.hpp"
#include "device_bridge/doctor/examine.hpp"
#include "device_bridge/servo_thread.hpp"

namespace irdm::commission {
namespace {

constexpr const char* kDriver = "driver";

std::string today() {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  ::localtime_r(&now, &local);
  std::string text(16, '\0');
  text.resize(std::strftime(text.data(), text.size(), "%Y-%m-%d", &local));
  return text;
}

// What the doctor finds of this device and machine; warnings do not count, and how well the loop
// keeps its time has a step of its own.
StepRecord examine_driver(const BridgeConfig& config) {
  BridgeConfig alone = config;
  alone.server.reset();
  std::string problems;
  for (const auto& [grade, subject, what, remedy] : doctor::examine(alone)) {
    if (grade != doctor::Grade::kProblem || subject == "wake-up") continue;
    problems += (problems.empty() ? "" : "; ") + subject + ": " + what;
    if (!remedy.empty()) problems += "; " + remedy;
  }
  if (problems.empty()) return {kDriver, Verdict::kPassed, "no problem found"};
  return {kDriver, Verdict::kFailed, problems};
}

/// The servo loop of a device, open as long as it lives.
class OpenLoop {
 public:
  OpenLoop(HapticDevice& device, const BridgeConfig& config) : device_(device) {
    device_.open();
    FilterLimits limits = filter_limits(device, config);
    limits.max_torque = 0.0;
    max_force_ = limits.max_force;
    loops_.emplace_back(device, limits,
                        DeviceMapping{.buttons = config.devices[0].mapping.buttons});
    runner_.emplace(loops_.front(), link_);
    servo_.emplace(link_, loops_,
                   ServoSettings{.rate = config.rate,
                                 .scheduling = config.realtime,
                                 .duration = std::numeric_limits<double>::infinity(),
                                 .log = &*runner_},
                   done_);
    lock_memory(config.realtime);
    link_.state.put({.linked = true, .sessions = 1, .dt = 1.0 / config.rate});
    try {
      servo_->start();
    } catch (...) {
      servo_.reset();  // its thread may run already
      device_.close();
      throw;
    }
  }
  OpenLoop(const OpenLoop&) = delete;
  OpenLoop& operator=(const OpenLoop&) = delete;
  ~OpenLoop() {
    servo_->stop();
    device_.close();
  }

  double max_force() const noexcept { return max_force_; }
  StepRunner& runner() noexcept { return *runner_; }
  /// There are no ticks any more.
  bool over() noexcept {
    constexpr int kSilentLooks = 3;  // one is seen by a process that was itself asleep
    silent_ = servo_->driver_silent(monotonic_ns()) ? silent_ + 1 : 0;
    over_ = over_ || done_.consume() || silent_ >= kSilentLooks;
    return over_;
  }

 private:
  HapticDevice& device_;
  double max_force_ = 0.0;
  std::vector<ServoLoop> loops_;
  ServoLink link_{1};
  EventFd done_;
  std::optional<StepRunner> runner_;
  std::optional<ServoThread> servo_;
  int silent_ = 0;  ///< looks in a row
  bool over_ = false;
};

StepRecord run_step(Step& step, OpenLoop& loop, Person& person, Measured& measured) {
  constexpr int kLookMs = 20;
  if (!person.begins(step)) return {step.name(), Verdict::kStopped, "ended by the person"};
  bool stopped = false;
  loop.runner().begin(step);
  for (;;) {
    const bool over = loop.over();  // first: a step's end comes before that of the ticks
    if (loop.runner().ended().consume()) break;
    if (over) return {step.name(), Verdict::kFailed, "the device was lost; check power and cable"};
    if (person.stops(kLookMs)) {
      stopped = true;
      loop.runner().stop();
    }
  }
  if (stopped) return {step.name(), Verdict::kStopped, "by a key"};
  return judged(step, measured);
}

/// Takes down how steps end, in their order.
class Protocol {
 public:
  Protocol(Report& report, Person& person) : report_(report), person_(person) {}

  /// False when it is the last one.
  bool add(StepRecord record, const std::string& trouble = {}) {
    const bool passed = record.verdict == Verdict::kPassed;
    if (!passed && !trouble.empty()) record.words += " (" + trouble + ")";
    const char* const word = passed                                ? "passed"
                             : record.verdict == Verdict::kStopped ? "stopped"
                                                                   : "failed";
    person_.tell("  " + std::string(word) + ": " + record.words);
    report_.steps.push_back(std::move(record));
    return passed;
  }

 private:
  Report& report_;
  Person& person_;
};

bool run_plan(const std::vector<std::unique_ptr<Step>>& plan, HapticDevice& device, OpenLoop& loop,
              Person& person, Report& report) {
  Protocol protocol(report, person);
  for (const auto& step : plan) {
    if (!protocol.add(run_step(*step, loop, person, report.measured), device.trouble())) {
      return false;
    }
  }
  return true;
}

bool run_with_device(const BridgeConfig& config, HapticDevice& device, Person& person,
                     Report& report) {
  std::vector<std::unique_ptr<Step>> plan;  // outlives the ticks
  OpenLoop loop(device, config);
  report.device = device.identity();
  plan = make_plan({.rate = config.rate,
                    .max_force = loop.max_force(),
                    .buttons = config.devices[0].mapping.buttons,
                    .simulated = device.simulated()});
  const bool passed = run_plan(plan, device, loop, person, report);
  for (std::size_t i = report.steps.size() - 1; i < plan.size(); ++i) {
    report.steps.push_back({.step = plan[i]->name()});
  }
  return passed;
}

}  // namespace

Report commission(const BridgeConfig& config, HapticDevice& device, Person& person,
                  const std::vector<std::string>& pushing) {
  Report report{.type = config.devices[0].type, .name = config.devices[0].name, .date = today()};
  person.tell(std::string("\n") + kDriver + ": Looks at driver, permissions and clock.");
  const bool examined = Protocol(report, person).add(examine_driver(config));
  const bool passed = examined && run_with_device(config, device, person, report);
  if (device.simulated() || !examined) return report;
  if (passed) {
    Protocol(report, person).add(run_kill_step(pushing, person, report.measured));
  } else {
    report.steps.push_back({.step = kKillStep});
  }
  return report;
}

void push_until_stopped(const BridgeConfig& config, HapticDevice& device, StopSignal& signal) {
  /// Nobody to talk to.
  class Nobody final : public Person {
   public:
    explicit Nobody(StopSignal& signal) : signal_(signal) {}
    void tell(const std::string&) override {}
    bool begins(const Step&) override { return true; }
    bool confirms(const std::string&) override { return false; }
    bool stops(int timeout_ms) override { return signal_.wait_for(timeout_ms); }

   private:
    StopSignal& signal_;
  } nobody(signal);
  StopStep step(StopStep::Event::kCable, -1);
  OpenLoop loop(device, config);
  Measured measured;
  run_step(step, loop, nobody, measured);
}

}  // namespace irdm::commission
