// Fail-to-zero latency, the time from a fault to zero force: a stylus presses a cube, irdm-server
// in a process of its own, the bridge's own threads, and between them a relay that makes things go
// wrong at random moments. For each cause the time from the last good frame that was passed on (or
// from the fault, if later ones came all along) to the first tick without force.
//   bench_fail_to_zero [TIMES] [CAUSE]      20 of each cause and mode unless given
// Beside it the longest gap between two ticks in that time: the machine's own noise.
#include <sys/ptrace.h>
#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <optional>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "bench/frame_relay.hpp"
#include "bench/statistics.hpp"
#include "common/program/stop_signal.hpp"
#include "common/realtime/clock.hpp"
#include "device_bridge/network_client.hpp"
#include "device_bridge/servo_thread.hpp"
#include "tests/system/stage.hpp"

using namespace irdm;

namespace {

constexpr std::int64_t kMillisecond = 1'000'000;

struct Tick {
  std::int64_t time_ns = 0;
  double force = 0.0;  ///< [N]
};

/// Comes down onto the cube's top and stays there. What it is told to show is kept.
class PressingDevice : public HapticDevice {
 public:
  PressingDevice() : ticks_(kKept) {}
  void open() override {}
  void close() noexcept override {}
  StylusPose read(double) noexcept override {
    constexpr double kWay = 1e-4;  // a tick [m]
    height_ = presses_ ? std::max(height_ - kWay, 0.054) : std::min(height_ + kWay, kAbove);
    above_ = height_ == kAbove;
    return {.tip = Vector3(0.01, height_, 0.005)};
  }
  void write(const Wrench& shown) noexcept override {
    const std::size_t i = written_.load(std::memory_order_relaxed);
    ticks_[i % kKept] = {monotonic_ns(), shown.force.norm()};
    written_.store(i + 1, std::memory_order_release);
  }
  bool simulated() const noexcept override { return true; }
  double duration() const noexcept override { return 1e9; }

  /// Any thread, as the others below: down onto the cube, or up from it.
  void press(bool wanted) { presses_ = wanted; }
  bool above() const { return above_; }
  Tick newest() const {
    const std::size_t count = written_.load(std::memory_order_acquire);
    return count == 0 ? Tick{} : ticks_[(count - 1) % kKept];
  }
  std::vector<Tick> since(std::int64_t time_ns) const {
    std::vector<Tick> found;
    const std::size_t end = written_.load(std::memory_order_acquire);
    for (std::size_t i = end > kKept / 2 ? end - kKept / 2 : 0; i < end; ++i) {
      if (ticks_[i % kKept].time_ns >= time_ns) found.push_back(ticks_[i % kKept]);
    }
    return found;
  }

 private:
  static constexpr std::size_t kKept = 1 << 14;
  std::vector<Tick> ticks_;
  std::atomic<std::size_t> written_{0};
  static constexpr double kAbove = 0.063;
  double height_ = kAbove;
  std::atomic<bool> presses_{false};
  std::atomic<bool> above_{true};
};

void sleep_ms(std::int64_t ms) {
  sleep_until(monotonic_ns() + ms * kMillisecond);
}

/// The thread of a process with the highest real-time priority; 0: none has one.
pid_t most_urgent_thread(pid_t pid) {
  pid_t found = 0;
  long highest = 0;
  for (const auto& task :
       std::filesystem::directory_iterator("/proc/" + std::to_string(pid) + "/task")) {
    std::ifstream file(task.path() / "stat");
    std::string text((std::istreambuf_iterator<char>(file)), {});
    std::istringstream fields(text.substr(text.rfind(')') + 2));
    std::vector<std::string> values(std::istream_iterator<std::string>(fields), {});
    constexpr std::size_t kPriority = 37;  // rt_priority, the 40th of all
    const long priority = std::stol(values.at(kPriority));
    if (priority > highest) {
      highest = priority;
      found = static_cast<pid_t>(std::stol(task.path().filename().string()));
    }
  }
  return found;
}

/// Server, relay and bridge.
class Rig {
 public:
  explicit Rig(bool predict) : predict_(predict), link_(1) {
    stage_.write("scene.toml",
                 test::scene_text() + "tether = { stiffness = 500, angular_stiffness = 5 }\n");
    server_.emplace(stage_.start_server());
    relay_.emplace(server_->port);
    loops_.emplace_back(device_, FilterLimits{});
    client_.emplace(
        link_,
        ClientSettings{
            .server = {"127.0.0.1", relay_->port()}, .lockstep = false, .predict = predict},
        done_);
    servo_.emplace(link_, loops_,
                   ServoSettings{.scheduling = RealTimeScheduling::kPrefer,
                                 .duration = std::numeric_limits<double>::infinity()},
                   done_);
    servo_->start();
    client_->start();
  }
  ~Rig() {
    servo_->stop();
    client_->stop();
  }

  // From outside: a tip that is inside when the session begins touches nothing.
  void press() {
    device_.press(false);
    for (int i = 0; !device_.above() || !linked(); ++i) wait(i);
    sleep_ms(100);  // what is old has left the link
    device_.press(true);
    for (int i = 0; device_.newest().force < 0.3; ++i) wait(i);
  }
  std::int64_t last_good_ns() const {
    return predict_ ? relay_->last_model_ns() : relay_->last_force_ns();
  }
  PressingDevice& device() { return device_; }
  FrameRelay& relay() { return *relay_; }
  pid_t server() const { return server_->process.pid(); }
  void kill_server() {
    server_->process.signal(SIGKILL);
    server_->process.wait();
  }
  void restart_server() {
    const std::uint16_t port = server_->port;
    server_.reset();
    server_.emplace(stage_.restart_server(port, {}));
  }

 private:
  bool linked() const { return monotonic_ns() - last_good_ns() < 50 * kMillisecond; }
  static void wait(int count) {
    if (count > 10'000) throw std::runtime_error("no force in 10 s");
    sleep_ms(1);
  }

  bool predict_;
  test::Stage stage_;
  std::optional<test::Server> server_;
  std::optional<FrameRelay> relay_;
  PressingDevice device_;
  std::vector<ServoLoop> loops_;
  ServoLink link_;
  EventFd done_;
  std::optional<NetworkClient> client_;
  std::optional<ServoThread> servo_;
};

struct Cause {
  std::string name;
  std::function<void(Rig&)> begin;
  std::function<void(Rig&)> end;
};

Cause relayed(const char* name, RelayFault fault) {
  return {name, [fault](Rig& rig) { rig.relay().set(fault); },
          [](Rig& rig) { rig.relay().set(RelayFault::kNone); }};
}

std::vector<Cause> causes() {
  return {
      {"server killed", [](Rig& rig) { rig.kill_server(); },
       [](Rig& rig) { rig.restart_server(); }},
      {"server stopped", [](Rig& rig) { ::kill(rig.server(), SIGSTOP); },
       [](Rig& rig) { ::kill(rig.server(), SIGCONT); }},
      {"force thread frozen",
       [](Rig& rig) {
         const pid_t thread = most_urgent_thread(rig.server());
         if (thread == 0 || ::ptrace(PTRACE_SEIZE, thread, nullptr, nullptr) != 0 ||
             ::ptrace(PTRACE_INTERRUPT, thread, nullptr, nullptr) != 0) {
           throw std::runtime_error("not permitted here");
         }
       },
       [](Rig& rig) {
         const pid_t thread = most_urgent_thread(rig.server());
         ::waitpid(thread, nullptr, __WALL);
         ::ptrace(PTRACE_DETACH, thread, nullptr, nullptr);
       }},
      relayed("connection reset", RelayFault::kReset),
      relayed("black hole", RelayFault::kBlackHole),
      relayed("nothing from the server, then all of it", RelayFault::kSilentServer),
      relayed("nothing from the bridge", RelayFault::kSilentBridge),
      relayed("corrupted", RelayFault::kCorrupted),
      relayed("reordered", RelayFault::kReordered),
      relayed("slow reader", RelayFault::kSlow),
      relayed("another session's frames", RelayFault::kOtherSession),
      relayed("every frame twice", RelayFault::kRepeated),
  };
}

struct Result {
  std::vector<double> to_zero;  ///< [ms]
  std::vector<double> gap;      ///< [ms]
  int never = 0;
};

Result measure(Rig& rig, const Cause& cause, int times) {
  constexpr std::int64_t kWatchedMs = 300;
  static std::mt19937 random(1);
  Result result;
  for (int i = 0; i < times; ++i) {
    rig.press();
    sleep_until(monotonic_ns() + static_cast<std::int64_t>(random() % 20'000) * 1000);
    cause.begin(rig);
    const std::int64_t wrong_ns = monotonic_ns();
    sleep_ms(kWatchedMs);
    const std::vector<Tick> ticks = rig.device().since(wrong_ns);
    const auto zero = std::find_if(ticks.begin(), ticks.end(),
                                   [](const Tick& tick) { return tick.force == 0.0; });
    const std::int64_t good_ns = std::max(wrong_ns, rig.last_good_ns());
    cause.end(rig);
    if (zero == ticks.end()) {
      ++result.never;
      continue;
    }
    const double to_ms = 1.0 / static_cast<double>(kMillisecond);
    // A good frame that comes after the force has gone is of no use.
    const std::int64_t from_ns = good_ns < zero->time_ns ? good_ns : wrong_ns;
    result.to_zero.push_back(to_ms * static_cast<double>(zero->time_ns - from_ns));
    std::int64_t gap_ns = 0;
    for (auto tick = ticks.begin(); tick != zero; ++tick) {
      gap_ns = std::max(gap_ns, (tick + 1)->time_ns - tick->time_ns);
    }
    result.gap.push_back(to_ms * static_cast<double>(gap_ns));
  }
  return result;
}

void print(const std::string& name, const Result& result) {
  const auto& times = result.to_zero;
  if (times.empty()) {
    std::printf("| %s | 0 | | | %d | |\n", name.c_str(), result.never);
    return;
  }
  std::printf("| %s | %zu | %.1f | %.1f | %d | %.1f |\n", name.c_str(), times.size(),
              bench::percentile(times, 0.5), bench::percentile(times, 1.0), result.never,
              bench::percentile(result.gap, 1.0));
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const StopSignal ignores_pipes;
  const int times = argc > 1 ? std::atoi(argv[1]) : 20;
  const std::string only = argc > 2 ? argv[2] : "";
  for (const bool predict : {false, true}) {
    std::printf("%s, at most %d ms from the last good frame:\n", predict ? "predict" : "hold",
                predict ? 80 : 50);
    std::printf(
        "| what | times | median [ms] | longest | never in 300 ms | longest gap of ticks |\n"
        "| --- | --- | --- | --- | --- | --- |\n");
    Rig rig(predict);
    for (const Cause& cause : causes()) {
      if (!only.empty() && cause.name != only) continue;
      try {
        print(cause.name, measure(rig, cause, times));
      } catch (const std::runtime_error& error) {
        std::printf("| %s | %s | | | | |\n", cause.name.c_str(), error.what());
      }
    }
  }
  return 0;
}
