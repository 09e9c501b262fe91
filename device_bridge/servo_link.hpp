#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/realtime/mailbox.hpp"
#include "common/realtime/wakeup.hpp"
#include "common/stylus.hpp"
#include "device_bridge/servo_input.hpp"

namespace irdm {

/// What the servo thread knows of the connection.
struct LinkState {
  bool linked = false;         ///< a session is on
  bool server_ended = false;   ///< the last session ended with the server's goodbye
  std::uint64_t sessions = 0;  ///< welcomed so far
  bool lockstep = false;       ///< of the newest session
  double dt = 0.0;             ///< force step of the newest session [s]
};

/// Hand-over between servo thread and network thread. Neither ever waits for the other.
struct ServoLink {
  struct Stylus {
    Mailbox<StylusSample> sample;           ///< servo writes
    Mailbox<ServoInput> input;              ///< network writes
    std::atomic<bool> armed{false};         ///< servo writes; and the next
    std::atomic<double> success_rate{0.0};  ///< LinkGate's
  };
  explicit ServoLink(std::size_t count) : styluses(count) {}

  std::vector<Stylus> styluses;
  Mailbox<LinkState> state;  ///< network writes
  Wakeup samples_ready;      ///< servo to network: the samples of a tick are there
  Wakeup news;               ///< network to servo: input or state changed
};

}  // namespace irdm
