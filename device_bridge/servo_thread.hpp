#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "common/realtime/event_fd.hpp"
#include "common/realtime/histogram.hpp"
#include "common/realtime/scheduling.hpp"
#include "device_bridge/blackbox/tick_log.hpp"
#include "device_bridge/link/simulated_link.hpp"
#include "device_bridge/servo_link.hpp"
#include "device_bridge/servo_loop.hpp"

namespace irdm {

class LinkSimulation;

struct ServoSettings {
  double rate = 1000.0;  ///< ticks a second, > 0
  RealTimeScheduling scheduling = RealTimeScheduling::kIgnore;
  double duration = 0.0;  ///< of a session's time, after which the thread ends [s]; infinity: never
  std::optional<SimulatedLink> link = {};  ///< in lockstep; none: no delay, and forces are held
  TickListener* log = nullptr;             ///< is told of every tick in real time; null: nobody is
};

enum class ServoEnd {
  kStopped,      ///< told to
  kFinished,     ///< the duration is over
  kLinkLost,     ///< lockstep: the connection broke
  kServerEnded,  ///< lockstep: the server said goodbye
  kDeviceLost,   ///< a device no longer gives readings
  kDriverStuck,  ///< the driver that makes the ticks does not any more
};

struct ServoReport {
  ServoEnd end = ServoEnd::kStopped;
  bool lockstep = false;
  double session_time = 0.0;  ///< [s]
  std::uint64_t ticks = 0;    ///< in lockstep: steps
  std::uint64_t missed = 0;   ///< ticks skipped because the loop was late; real time only
  Histogram wakeup;           ///< how late a tick began [ns]; real time only
  Histogram round_trip;       ///< sample given to force there [ns]; lockstep only
};

/// Runs the servo loops of all styluses: at a fixed rate in real time, or step by step on the
/// server's simulated clock. Where a device has a tick source, there is no thread of ours: the
/// ticks of all devices are that source's. Until the first session is welcomed the devices rest
/// where they begin, without force. When it ends in real time, the force fades first.
/// Large: each private method is one phase or one duty of a tick, of one thread.
class ServoThread {
 public:
  /// @param loops one for each stylus of the link, opened devices; used by the thread until stop()
  /// @param done signalled when the thread ends by itself
  ServoThread(ServoLink& link, std::vector<ServoLoop>& loops, const ServoSettings& settings,
              EventFd& done);
  ServoThread(const ServoThread&) = delete;
  ServoThread& operator=(const ServoThread&) = delete;
  ~ServoThread();  ///< stops

  /// Throws Error when real-time scheduling is required and not permitted, or a driver does not
  /// make ticks.
  void start();
  /// Ends the thread and waits for it. Further calls do nothing.
  void stop();
  /// Whether a driver that makes the ticks has made none for a second. Any thread, until stop().
  bool driver_silent(std::int64_t now_ns) const noexcept;
  /// After stop().
  const ServoReport& report() const noexcept { return report_; }
  /// How the thread is scheduled, for a report; after start().
  const std::string& scheduling() const noexcept { return scheduling_; }

 private:
  enum class Phase { kWaiting, kRunning, kFading, kOver };

  void find_source();
  void start_source();
  void stop_source();
  bool source_tick() noexcept;
  void run() noexcept;
  void run_real_time() noexcept;
  ServoEnd run_lockstep() noexcept;
  ServoEnd run_over_link();
  bool exchange(LinkSimulation& link, std::uint64_t k);
  bool finished(double time) noexcept;
  ServoEnd lockstep_end() noexcept;
  bool tick(std::int64_t now_ns) noexcept;
  void wait_for_session(std::int64_t now_ns) noexcept;
  void render_tick(std::int64_t now_ns) noexcept;
  void fade(std::int64_t now_ns) noexcept;
  void write_down(std::size_t i, std::int64_t now_ns) noexcept;
  void end(ServoEnd end, std::int64_t now_ns) noexcept;
  void begin_session(const LinkState& state) noexcept;
  void end_steps(std::size_t i, std::int64_t now_ns) noexcept;
  void publish_applied(std::size_t i) noexcept;
  void step(std::uint64_t k) noexcept;
  bool wait_for_forces(std::uint64_t k) noexcept;

  ServoLink& link_;
  std::vector<ServoLoop>& loops_;
  ServoSettings settings_;
  EventFd& done_;
  std::uint64_t session_ = 0;  ///< that the loops are in
  ServoReport report_;
  std::string scheduling_;
  Phase phase_ = Phase::kWaiting;
  std::int64_t start_ns_ = 0;                  ///< of the session's time
  std::int64_t fade_from_ns_ = 0;              ///< when the fading began
  std::int64_t late_ns_ = 0;                   ///< by how much this tick began too late
  TickSource* source_ = nullptr;               ///< whose ticks they are; none: our own thread's
  std::atomic<std::int64_t> last_tick_ns_{0};  ///< of the source
  EventFd source_ended_;                       ///< the source's last tick is over
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace irdm
