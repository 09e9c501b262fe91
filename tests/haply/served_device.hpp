#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "device_bridge/haply/haply_device.hpp"
#include "device_bridge/servo_thread.hpp"
#include "tests/haply/fake_service.hpp"

namespace irdm::test {

/// What was shown, tick by tick.
struct ShownTicks final : TickListener {
  ShownTicks() { rows.reserve(kMost); }
  void put(const TickRow& row) noexcept override {
    if (rows.size() < kMost) rows.push_back({row.time_ns, row.device.ready, row.force.norm()});
  }
  static constexpr std::size_t kMost = 500'000;
  struct Row {
    std::int64_t time_ns;
    bool ready;
    double force;  ///< [N]
  };
  std::vector<Row> rows;
};

/// A Haply device in a servo thread, and a server that always asks for the same force.
struct ServedDevice {
  static constexpr double kDemand = 2.0;  ///< [N], up

  explicit ServedDevice(const FakeService& service) : device(service.settings()) {
    device.open();
    loops.emplace_back(device, FilterLimits{});
    servo.emplace(link, loops,
                  ServoSettings{.duration = std::numeric_limits<double>::infinity(), .log = &shown},
                  done);
    servo->start();
    link.state.put({.linked = true, .sessions = 1, .dt = 0.002});
  }
  /// Answers the newest sample.
  void serve() {
    if (!link.styluses[0].sample.receive()) return;
    link.styluses[0].input.put({.linked = true,
                                .any_force = true,
                                .force = {.sample_time_ns = link.styluses[0].sample.front().time_ns,
                                          .force = Vector3(0, kDemand, 0)}});
  }
  /// Whether the service was told the whole force last.
  bool felt(const FakeService& service) {
    serve();
    return service.told().force.z() > 0.9 * kDemand;
  }

  HaplyDevice device;
  std::vector<ServoLoop> loops;
  ServoLink link{1};
  EventFd done;
  ShownTicks shown;
  std::optional<ServoThread> servo;
};

}  // namespace irdm::test
