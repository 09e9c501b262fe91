#pragma once

#include <array>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace irdm::test {

/// What the fake Inverse Service knows, behind one mutex: devices, a grip, and faults to order.
/// Behaviour is taken from these sources, named WS, SIM, CMD, EVT, CFG, MIG, OLD and USE below:
/// - WS: docs.haply.co/inverseSDK/service/realtime/websocket-protocol (3.5): the first message has
///   session_id, config, state and status; then one state for each message
/// - SIM: .../service/api/simulation (3.5): states have state and status of all devices;
///   force_render_full_state brings the configuration again; probe_position
/// - CMD: .../service/realtime/control-commands (3.5): set_cursor_force has a `vector`; a command
///   is applied once, and without more of them the device returns to idle
/// - EVT: .../service/events (3.5): events of name, level, data and message, on a channel of their
///   own that takes none
/// - CFG: .../service/session-configuration/device-config (3.5): gravity compensation is set by
///   HTTP alone, POST /inverse3/ID/config/gravity_compensation; how its body looks is inferred from
///   the configuration in WS
/// - MIG: .../service/migrations/3.5-migration: HTTP of 3.0 on port 10000, POST
///   /gravity_compensation
/// - OLD: .../inverseSDK/3.0.7/service: a force must be sent to read, if it is zero
/// - USE: clients before 3.5: `values` (Isaac Lab, Haply's samples for 3.1), status in each message
///   (SofaHaplyRobotics), body of gravity_compensation (ABC-iRobotics/haply_ros2_interface)
class FakeWorld {
 public:
  using Json = nlohmann::json;
  using Clock = std::chrono::steady_clock;

  /// @param old 3.0 instead of 3.5
  FakeWorld(bool old, const std::vector<std::string>& ids);

  /// The first message (WS), or one that was asked for (SIM).
  std::string full_state();
  /// Takes a message and answers it; none: silence.
  std::optional<std::string> answer(const std::string& message);
  /// Of HTTP; none: 404.
  std::optional<std::string> answer_http(const std::string& method, const std::string& target,
                                         const std::string& body);
  /// A line of an order, and what to say to it.
  std::string obey(const std::string& line);
  /// Somebody listens to events (EVT) from now on: the number of the next one.
  std::size_t listen();
  /// Waits for that one.
  std::string event(std::size_t number);
  /// How long answers are to wait.
  std::chrono::milliseconds delay();

 private:
  struct Device {
    std::string id;
    bool plugged = true;
    bool calibrated = true, ready = true, power_supply = true, in_use = false;
    bool gravity = false;
    std::array<double, 3> position{0.0, -0.12, 0.15};  // [m], the service's axes
    std::array<double, 3> force{};                     // commanded last [N]
    double largest = 0.0;                              // magnitude so far [N]
    std::uint64_t forces = 0;                          // so far
  };

  Json describe(const Device& device, bool with_config);
  Json describe_grip(bool with_config) const;
  std::string state(bool with_config);
  void take(const Json& message);
  void take_force(Device& device, const Json& command);
  Device* find(const std::string& id);
  std::array<double, 3> where(const Device& device) const;

  std::mutex mutex_;
  const bool old_;
  std::vector<Device> devices_;
  std::array<double, 4> turned_{1, 0, 0, 0};  // of the grip, w x y z
  std::string pressed_;                       // letters of its buttons
  bool grip_ = true;
  bool silent_ = false;
  std::string garbage_;  // in the place of answers; empty: none
  std::string number_;   // in the place of cursor_position.x; empty: itself
  std::chrono::milliseconds delay_{0};
  std::optional<Clock::time_point> pressing_since_;  // the hand goes up and down by itself
  std::uint64_t misuses_ = 0;                        // what the documents do not permit
  std::string misuse_;                               // the last
  int sessions_ = 0;
  std::vector<std::string> events_;
  std::condition_variable event_told_;
  int listeners_ = 0;  ///< so far
};

}  // namespace irdm::test
