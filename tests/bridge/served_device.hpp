#pragma once

#include <atomic>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "device_bridge/servo_thread.hpp"

namespace irdm::test {

/// What was shown, tick by tick. Each is answered at once by a server that always asks for the same
/// force: a test that stands still for a while takes none away.
struct ShownTicks final : TickListener {
  static constexpr double kDemand = 2.0;  ///< [N], up
  static constexpr std::size_t kMost = 500'000;
  struct Row {
    std::int64_t time_ns;
    bool ready;
    double force;  ///< [N]
  };

  explicit ShownTicks(ServoLink& to) : link(to) { rows.reserve(kMost); }
  void put(const TickRow& row) noexcept override {
    link.styluses[0].input.put(
        {.linked = true,
         .any_force = true,
         .force = {.sample_time_ns = row.time_ns, .force = Vector3(0, kDemand, 0)}});
    const double force = row.force.norm();
    if (rows.size() < kMost) rows.push_back({row.time_ns, row.device.ready, force});
    if (!row.device.ready && force == 0.0) ++silent;
  }

  ServoLink& link;
  std::vector<Row> rows;
  std::atomic<int> silent = 0;  ///< ticks so far that were not ready, and without force
};

/// A device in a servo thread, open, and what it shows once a session has begun.
template <typename Device>
struct ServedDevice {
  static constexpr double kDemand = ShownTicks::kDemand;

  /// @param arguments of the device
  template <typename... Arguments>
  explicit ServedDevice(Arguments&&... arguments) : device(std::forward<Arguments>(arguments)...) {
    device.open();
    loops.emplace_back(device, FilterLimits{});
    servo.emplace(link, loops,
                  ServoSettings{.duration = std::numeric_limits<double>::infinity(), .log = &shown},
                  done);
    servo->start();
  }
  void begin_session() { link.state.put({.linked = true, .sessions = 1, .dt = 0.002}); }

  Device device;
  std::vector<ServoLoop> loops;
  ServoLink link{1};
  EventFd done;
  ShownTicks shown{link};
  std::optional<ServoThread> servo;
};

}  // namespace irdm::test
