#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "device_bridge/blackbox/tick_log.hpp"
#include "device_bridge/bridge_config.hpp"
#include "device_bridge/network_client.hpp"
#include "device_bridge/servo_thread.hpp"

namespace irdm {

/// How a program connects that is a stylus itself.
struct StylusSettings {
  BridgeConfig bridge = {};  ///< with a server; its devices do not count
  Workspace workspace = {};  ///< key `workspace`: of the program's frame D in W; not in lockstep
  StylusPose start = {};     ///< key `tip`: until the first pose is set, D; not in lockstep
  bool lockstep = false;     ///< key `lockstep`: the server's steps wait for the program's
  std::optional<int> number =
      {};                ///< key `stylus`: of the scene, 0 to 15; none: the first free one
  double timeout = 5.0;  ///< key `timeout`: to connect [s], 0.05 to 3600
  /// Key `stale_after`: a pose counts for so long, then the stylus is not ready [s], 0.01 to 10.
  double stale_after = 0.05;
};

/// Reads the keys above and those of read_servo_keys(). Throws Error.
/// @param address HOST:PORT
StylusSettings read_stylus_settings(const std::string& address, TomlTable options);

/// What a program gets back. In real time as shown by the safety filter, D; in lockstep as the
/// server found it, W.
struct StylusFeedback {
  std::int64_t time_ns = 0;  ///< of the tick, monotonic clock; in lockstep of the step
  bool ready = false;        ///< linked, armed, poses are set
  bool linked = false;
  bool fresh = false;  ///< a pose was set not longer ago than stale_after
  FilterState filter = FilterState::kDisarmed;
  ContactState contact = ContactState::kFree;
  double success_rate = 0.0;         ///< of the link, see LinkGate
  double gain = 1.0;                 ///< see OscillationDetector
  Vector3 force = Vector3::Zero();   ///< on the stylus [N]
  Vector3 torque = Vector3::Zero();  ///< about its tip [N m]
  /// Age of the tip that the force answers [s]; NaN: no force yet. In lockstep: 0.
  double latency = std::numeric_limits<double>::quiet_NaN();
  std::uint64_t ticks = 0;       ///< of the servo loop; in lockstep: steps
  std::uint64_t late_ticks = 0;  ///< left out, as the loop was late for more than a period
  std::uint64_t sessions = 0;    ///< with a server, so far
};

/// The device that a program is. A pose that is too old means a device that is not ready: no force,
/// and the tip stays.
class ProgramDevice final : public HapticDevice {
 public:
  ProgramDevice(const StylusPose& start, double stale_after);
  /// Program.
  void set(const StylusPose& pose, std::int64_t now_ns) noexcept { poses_.put({pose, now_ns}); }

  void open() override {}
  void close() noexcept override {}
  StylusPose read(double time) noexcept override;
  void write(const Wrench&) noexcept override {}
  DeviceState state() const noexcept override { return {.ready = fresh_}; }
  bool simulated() const noexcept override { return false; }
  double duration() const noexcept override { return std::numeric_limits<double>::infinity(); }

 private:
  struct Stamped {
    StylusPose pose;
    std::int64_t time_ns = 0;
  };
  TripleBuffer<Stamped> poses_;
  std::int64_t stale_ns_;
  bool fresh_ = false;
};

/// A program as a stylus of a server: in real time with a servo thread of its own, with link rules,
/// prediction and safety filter of a bridge; or step by step in lockstep, without them. set() by
/// one thread; all else by one thread, which may be another one.
class StylusClient {
 public:
  /// Called about every 50 ms while it waits; may throw, which ends the wait.
  using Meanwhile = std::function<void()>;

  /// Connects. Throws Error when no session begins within the timeout.
  explicit StylusClient(const StylusSettings& settings, const Meanwhile& meanwhile = {});
  StylusClient(const StylusClient&) = delete;
  StylusClient& operator=(const StylusClient&) = delete;
  ~StylusClient();  ///< lets the force fade and says goodbye; up to half a second

  /// What is wrong with a pose; null: nothing. Any thread, real-time safe.
  const char* fault_of(const StylusPose& pose) const noexcept;
  /// Real time: where the stylus is now. Real-time safe.
  /// @param pose without fault; D
  void set(const StylusPose& pose) noexcept;
  /// The newest. In real time a force is zero that is older than 50 ms. Real-time safe.
  StylusFeedback get() noexcept;
  /// Lockstep: the next step of the server, with the stylus here at its end. Throws Error when the
  /// run is over, and what `meanwhile` throws; there is no further step then.
  /// @param pose without fault; W
  StylusFeedback step(const StylusPose& pose, const Meanwhile& meanwhile = {});
  /// What it is at, and why there is no force, in a line. Not real-time safe.
  std::string state();

  bool lockstep() const noexcept { return settings_.lockstep; }
  double dt() noexcept { return client_.progress().link.dt; }  ///< force step of the server [s]
  int number() noexcept { return client_.progress().link.first_stylus; }  ///< in the scene

 private:
  struct Feedback final : TickListener {
    void put(const TickRow& row) noexcept override;
    TripleBuffer<StylusFeedback> newest;
    std::uint64_t ticks = 0;
  };

  ClientSettings client_settings() const;
  void await_session(const Meanwhile& meanwhile);
  void await_force(const Meanwhile& meanwhile);
  std::string address() const;

  StylusSettings settings_;
  EventFd done_;
  ProgramDevice device_;
  std::vector<ServoLoop> loops_;
  ServoLink link_{1};
  Feedback feedback_;
  StylusFeedback last_;          ///< lockstep: of the last step
  std::uint64_t next_step_ = 0;  ///< lockstep
  bool over_ = false;            ///< lockstep: no further step
  NetworkClient client_;
  std::optional<ServoThread> servo_;  ///< in real time
};

}  // namespace irdm
