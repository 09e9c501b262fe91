#pragma once

#include <cstdint>
#include <string>

#include "common/program/stop_signal.hpp"
#include "common/realtime/histogram.hpp"
#include "device_bridge/bridge_config.hpp"
#include "device_bridge/network_client.hpp"
#include "device_bridge/servo_link.hpp"

namespace irdm {

/// What is measured of a link in ticks of a servo loop. Adding is pure and real-time safe.
struct LinkMeasurement {
  static constexpr std::int64_t kHoldNs = 20'000'000;     ///< age that a held force may have
  static constexpr std::int64_t kPredictNs = 50'000'000;  ///< that of a contact model, at most

  /// One tick.
  /// @param late_ns how late it began  @param input what the servo loop knows then
  void tick(std::int64_t now_ns, std::int64_t late_ns, const ServoInput& input) noexcept;
  /// Share of the ticks whose newest force was young enough to be shown; 0 without ticks.
  double hold_success() const noexcept { return share(young_for_hold); }
  double predict_success() const noexcept { return share(young_for_predict); }
  /// Of the two, that of the bridge's mode.
  double success() const noexcept { return predict ? predict_success() : hold_success(); }
  /// Age that a force may have in that mode [ns]; with a contact model as far as it predicts.
  std::int64_t limit_ns() const noexcept { return predict ? predict_limit_ns() : kHoldNs; }
  std::int64_t predict_limit_ns() const noexcept;
  /// Share of the server's steps that did not arrive.
  double loss() const noexcept;

  std::uint64_t ticks = 0;
  std::uint64_t missed = 0;  ///< ticks skipped because the loop was late
  std::uint64_t young_for_hold = 0;
  std::uint64_t young_for_predict = 0;
  Histogram age;             ///< of the newest force at a tick [ns]
  Histogram wakeup;          ///< how late a tick began [ns]
  double duration = 0.0;     ///< [s]
  double dt = 0.0;           ///< the server's step [s], known before the first tick
  bool predict = false;      ///< the session's contact is solved at the bridge
  std::string scheduling;    ///< of the loop
  ClientReport client = {};  ///< of the network thread

 private:
  double share(std::uint64_t count) const noexcept;
};

/// Takes a stylus of the server, far away from everything, and measures for `duration`, or until a
/// signal comes. Throws when there is no session within a few seconds, or the server refuses.
/// @param config with a server; its devices are not touched
/// @param duration [s], > 0
LinkMeasurement probe_link(const BridgeConfig& config, double duration, StopSignal& stop_signal);

}  // namespace irdm
