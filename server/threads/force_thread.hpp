#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "common/realtime/event_fd.hpp"
#include "common/realtime/histogram.hpp"
#include "common/realtime/scheduling.hpp"
#include "common/realtime/triple_buffer.hpp"
#include "server/blackbox/step_log.hpp"
#include "server/network/network_server.hpp"
#include "server/threads/run_control.hpp"
#include "server/threads/step_clock.hpp"
#include "simulation/step/bridged_stylus.hpp"
#include "simulation/step/simulation.hpp"
#include "simulation/step/step_record.hpp"

namespace irdm {

/// Turns what a pointing device says some 60 times a second into a stylus that the force step can
/// follow: smooth, never faster than a hand, and pressing no harder than allowed, as no hand gives
/// way here. Pure; real-time safe.
class ViewerStylus {
 public:
  static constexpr double kSmoothing = 0.015;  ///< time constant [s]
  static constexpr double kFastest = 1.0;      ///< [m/s]

  /// @param stiffness of the spring between tip and surface [N/m]; 0: none, and then no bound
  /// @param max_force that it pushes or pulls with at most [N]; 0: no bound
  ViewerStylus(double dt, double stiffness, double max_force) noexcept
      : dt_(dt), stiffness_(stiffness), max_force_(max_force) {}

  /// The stylus of the coming step.
  /// @param wanted where it is to be
  /// @param last what became of it in the last step
  StylusCommand next(const StylusCommand& wanted, const StylusRecord& last) noexcept;

 private:
  double dt_;
  double stiffness_;
  double max_force_;
  bool present_ = false;
  Vector3 tip_ = Vector3::Zero();
};

/// What the force thread counted; read after finish().
struct ForceThreadReport {
  std::uint64_t steps = 0;
  std::uint64_t resets = 0;        ///< how often everything was reset
  std::uint64_t unsolved = 0;      ///< steps whose contact problem had no finite solution
  std::uint64_t late = 0;          ///< forces of bridges that came after their step, and entered it
  std::uint64_t lost = 0;          ///< forces of bridges that came too late for that, or never
  std::uint64_t cache_misses = 0;  ///< Simulation::cache_misses()
  double peak_force = 0.0;         ///< largest |force| on a stylus [N]
  Histogram step_time;             ///< from the clock's go to the forces' hand-over [ns]
};

/// How the force thread fares while it runs.
struct ForceHealth {
  std::uint64_t steps = 0;  ///< this count and the next three: since the start
  std::uint64_t resets = 0;
  std::uint64_t unsolved = 0;
  std::uint64_t missed = 0;  ///< deadlines
  std::uint64_t cache_misses = 0;
  Histogram step_time;     ///< of the last kHealthPeriodNs [ns]
  Histogram wakeup_delay;  ///< of the last kHealthPeriodNs [ns]; empty in lockstep
};

/// Takes the newest stylus samples, makes the force step and hands on what came of it, once for
/// every go of the clock. Neither allocates, locks, throws, logs nor touches files while it runs.
/// Large: most members are hand-overs to other threads and counts; the step itself is in
/// Simulation.
class ForceThread {
 public:
  /// All of these must outlive the thread. @param steps how many to make; 0: until the clock stops
  ForceThread(Simulation& simulation, NetworkServer& network, RunControl& control, StepClock& clock,
              std::vector<StepSink*> sinks, std::uint64_t steps);
  ~ForceThread();

  /// Throws Error when real-time scheduling is required and not permitted.
  void start(RealTimeScheduling scheduling);
  void finish();
  /// The simulation's last stylus, beyond those of the network, is that of the viewers. Before
  /// start().
  void add_viewer_stylus(const ViewerStylus& stylus);
  /// Tells it of every step. Before start(); outlives the thread.
  void write_down_in(StepLog& log) noexcept { log_ = &log; }
  /// Becomes readable when the thread has made its last step.
  EventFd& finished() noexcept { return finished_; }
  const ForceThreadReport& report() const noexcept { return report_; }
  /// While it runs, anew about every kHealthPeriodNs; for one reader.
  TripleBuffer<ForceHealth>& health() noexcept { return health_; }
  /// The same for another one.
  TripleBuffer<ForceHealth>& status() noexcept { return status_; }
  static constexpr double kPauseFade = 0.03;  ///< in which a force fades when the run is paused [s]
  static constexpr std::int64_t kHealthPeriodNs = 1'000'000'000;
  /// How the thread is scheduled, for a report.
  const std::string& scheduling() const noexcept { return scheduling_; }

 private:
  void run() noexcept;
  void step() noexcept;
  void stand_still() noexcept;
  void predict_horizon() noexcept;
  void take_commands() noexcept;
  void write_down(std::int64_t begin_ns, std::int64_t end_ns) noexcept;
  void watch_health(std::int64_t begin_ns, std::int64_t end_ns) noexcept;

  Simulation& simulation_;
  NetworkServer& network_;
  RunControl& control_;
  StepClock& clock_;
  std::vector<StepSink*> sinks_;
  StepLog* log_ = nullptr;  ///< null: nobody
  std::uint64_t steps_;
  bool stood_still_ = false;
  bool continued_ = false;         ///< it stood still before this step
  std::uint64_t still_steps_ = 0;  ///< since it stands still
  std::optional<ViewerStylus> viewer_stylus_;
  std::vector<BridgedStylus> bridged_;   ///< of the network's styluses
  std::vector<StylusCommand> commands_;  ///< of the network's styluses, and perhaps the viewers'
  StepRecord record_;
  ForceThreadReport report_;
  ForceHealth window_;  ///< what is being gathered for health_
  std::int64_t window_begin_ns_ = 0;
  TripleBuffer<ForceHealth> health_;
  TripleBuffer<ForceHealth> status_;
  std::string scheduling_;
  EventFd finished_;
  std::thread thread_;
};

}  // namespace irdm
