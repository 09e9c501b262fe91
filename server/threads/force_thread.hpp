#pragma once

#include <array>
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
#include "server/threads/prediction_throttle.hpp"
#include "server/threads/run_control.hpp"
#include "server/threads/step_clock.hpp"
#include "server/threads/viewer_stylus.hpp"
#include "simulation/step/bridged_stylus.hpp"
#include "simulation/step/prediction_turns.hpp"
#include "simulation/step/simulation.hpp"
#include "simulation/step/step_record.hpp"

namespace irdm {

/// What a stylus' bridge sent that no hand does; none of it acts.
struct StylusFaults {
  std::uint64_t outside = 0;    ///< steps whose newest sample was beyond the world's bound
  std::uint64_t disagreed = 0;  ///< BridgedStylus::disagreed()
};

/// What the force thread counted; read after finish().
struct ForceThreadReport {
  std::uint64_t steps = 0;
  std::uint64_t resets = 0;        ///< how often everything was reset
  std::uint64_t unsolved = 0;      ///< steps whose contact problem had no finite solution
  std::uint64_t late = 0;          ///< forces of bridges that came after their step, and entered it
  std::uint64_t lost = 0;          ///< forces of bridges that came too late for that, or never
  std::uint64_t bounded = 0;       ///< forces of bridges above their stylus' max_force
  std::uint64_t withheld = 0;      ///< steps in contact that bridges had no model for
  std::uint64_t limited = 0;       ///< Simulation::limited()
  std::uint64_t cache_misses = 0;  ///< Simulation::cache_misses()
  double peak_force = 0.0;         ///< largest |force| on a stylus [N]
  /// StylusFaults of each stylus of the network.
  std::vector<StylusFaults> faults;
  Histogram step_time;        ///< from the clock's go to all that is handed over [ns]
  Histogram prediction_time;  ///< of which for contacts that bridges solve [ns]
};

/// How the force thread fares while it runs.
struct ForceHealth {
  std::uint64_t steps = 0;  ///< this count and the next six: since the start
  std::uint64_t resets = 0;
  std::uint64_t unsolved = 0;
  std::uint64_t missed = 0;  ///< deadlines
  std::uint64_t cache_misses = 0;
  std::uint64_t withheld = 0;  ///< as in the report, and the next
  std::array<StylusFaults, kMaxStyluses> faults = {};
  int prediction_period = 1;  ///< PredictionThrottle's
  Histogram step_time;        ///< of the last kHealthPeriodNs [ns]
  Histogram wakeup_delay;     ///< of the last kHealthPeriodNs [ns]; empty in lockstep
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
  /// Positions with a component beyond this are no hand's [m], W. Before start().
  void set_position_bound(double bound) noexcept { position_bound_ = bound; }
  /// Tells it of every step. Before start(); outlives the thread.
  void write_down_in(StepLog& log) noexcept { log_ = &log; }
  /// Becomes readable when the thread has made its last step.
  EventFd& finished() noexcept { return finished_; }
  const ForceThreadReport& report() const noexcept { return report_; }
  /// While it runs, anew about every kHealthPeriodNs; for one reader.
  TripleBuffer<ForceHealth>& health() noexcept { return health_; }
  /// The same for another one.
  TripleBuffer<ForceHealth>& status() noexcept { return status_; }
  /// In which a force fades when the run is paused, or its stylus' samples are not used [s].
  static constexpr double kFade = 0.03;
  static constexpr double kPositionBound = 10.0;  ///< default of set_position_bound() [m]
  static constexpr std::int64_t kHealthPeriodNs = 1'000'000'000;
  /// How the thread is scheduled, for a report.
  const std::string& scheduling() const noexcept { return scheduling_; }

 private:
  void run() noexcept;
  void step() noexcept;
  void fade_while_paused() noexcept;
  StylusRecord bounded(std::size_t s, const StylusRecord& stylus) const noexcept;
  void answer(std::size_t s, const StylusRecord& stylus) noexcept;
  StylusRecord faded(const StylusRecord& last, std::uint64_t steps,
                     const Vector3& tip) const noexcept;
  void fade_model(StylusPort& port) noexcept;
  void check_position(std::size_t s) noexcept;
  StylusFaults faults(std::size_t s) const noexcept;
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
  bool was_paused_ = false;
  bool continued_ = false;          ///< it was paused before this step
  std::uint64_t paused_steps_ = 0;  ///< since the pause began
  /// A stylus of the network whose newest sample may be beyond the bound.
  struct Outside {
    std::uint64_t steps = 0;  ///< since its samples are; 0: they are not
    StylusRecord last;        ///< of the step before that
    std::uint64_t steps_in_all = 0;
  };
  double position_bound_ = kPositionBound;
  std::vector<Outside> outside_;
  std::optional<ViewerStylus> viewer_stylus_;
  std::vector<BridgedStylus> bridged_;  ///< of the network's styluses
  PredictionThrottle throttle_;
  std::uint64_t overlong_ = 0;      ///< real-time steps longer than dt, since the last update
  std::uint64_t steps_before_ = 0;  ///< steps, until then
  PredictionTurns turns_;
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
