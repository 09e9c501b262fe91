#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/contact/applied_forces.hpp"
#include "common/contact/contact_model.hpp"
#include "common/realtime/event_fd.hpp"
#include "common/realtime/triple_buffer.hpp"
#include "common/stylus.hpp"

namespace irdm {

/// What the servo loop knows of the server's forces for one stylus.
struct ServoInput {
  bool linked = false;     ///< a session is on
  bool any_force = false;  ///< `force` is of this session (or of the last one, when not linked)
  StylusForce force = {};  ///< the newest
  bool ageless = false;    ///< it answers no tip, and is of now in each tick
};

/// What the servo thread knows of the connection.
struct LinkState {
  bool linked = false;         ///< a session is on
  bool server_ended = false;   ///< the last session ended with the server's goodbye
  std::uint64_t sessions = 0;  ///< welcomed so far
  bool lockstep = false;       ///< of the newest session
  bool predict = false;        ///< in the newest session the contact is solved here
  double dt = 0.0;             ///< force step of the newest session [s]
  int first_stylus = 0;        ///< the server's number of our first one
};

/// Hand-over between servo thread and network thread. Neither ever waits for the other.
struct ServoLink {
  struct Stylus {
    TripleBuffer<StylusSample> sample;               ///< servo writes
    TripleBuffer<ServoInput> input;                  ///< network writes
    TripleBuffer<OfSession<ContactModel>> model;     ///< network writes, in `predict`
    TripleBuffer<OfSession<AppliedForces>> applied;  ///< servo writes, then
    std::atomic<bool> armed{false};                  ///< servo writes; and the next
    std::atomic<bool> awaits_button{false};          ///< of a person, before there is force
    std::atomic<double> success_rate{0.0};           ///< LinkGate's
    std::atomic<double> gain{1.0};                   ///< of the OscillationDetector
    std::atomic<double> energy_share{1.0};           ///< SafetyFilter's
  };
  explicit ServoLink(std::size_t count) : styluses(count) {}

  std::vector<Stylus> styluses;
  TripleBuffer<LinkState> state;  ///< network writes
  EventFd samples_ready;          ///< servo to network: the samples of a tick are there
  EventFd news;                   ///< network to servo: input or state changed
};

}  // namespace irdm
