#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>

#include "common/contact/applied_forces.hpp"
#include "common/contact/contact_model.hpp"
#include "common/stylus.hpp"

/// The messages between bridge and server. docs/protocol.md is the document; this header is its
/// only translation, used by server, bridge and the scripted peers of the tests.
namespace irdm::wire {

inline constexpr std::uint32_t kProtocolMagic = 0x4D445249;  ///< the bytes "IRDM"
/// Version of header and payloads that this build writes, and the oldest that it still reads.
inline constexpr std::uint16_t kProtocolVersion = 1;
inline constexpr std::uint16_t kOldestProtocolVersion = 1;

inline constexpr std::size_t kHeaderSize = 36;
/// No payload of any version is longer; a longer announcement is refused before it is read.
inline constexpr std::size_t kMaxPayload = 16384;
inline constexpr std::size_t kNameSize = 32;
inline constexpr std::size_t kTextSize = 64;
/// Coordinates beyond this are a fault of the sender, not a place for a hand [m].
inline constexpr double kMaxCoordinate = 1000.0;
/// Longest force step that a Welcome may announce [s].
inline constexpr double kLongestStep = 1.0;
/// No hand exerts more [N].
inline constexpr double kMaxForce = 1000.0;

/// Reserved; refused by version 1: 19 Command (bridge to server).
enum class MessageType : std::uint16_t {
  kHello = 1,
  kWelcome = 2,
  kRefuse = 3,
  kGoodbye = 4,
  kSample = 5,
  kForce = 6,
  kReport = 7,
  kContactModel = 16,
  kAppliedForces = 17,
  kStatus = 18,
  kDatagrams = 20,
};

/// Bits of Hello::capabilities and Welcome::capabilities.
inline constexpr std::uint32_t kCapabilityStatus = 1u << 1;     ///< type 18
inline constexpr std::uint32_t kCapabilityCommand = 1u << 2;    ///< reserved: type 19
inline constexpr std::uint32_t kCapabilityReport = 1u << 3;     ///< type 7
inline constexpr std::uint32_t kCapabilityDatagrams = 1u << 4;  ///< type 20
/// Contact models in lockstep too: the bridge simulates the link.
inline constexpr std::uint32_t kCapabilitySimulatedLink = 1u << 5;
inline constexpr std::uint32_t kCapabilityContactModel = 1u << 6;  ///< types 16 and 17
inline constexpr std::uint32_t kCapabilityTorque = 1u << 7;        ///< type 6 carries the torque

/// What goes before every payload. The CRC32C that ends it is the codec's business.
struct Header {
  std::uint16_t version = kProtocolVersion;
  MessageType type = MessageType::kHello;
  std::uint32_t payload_size = 0;
  std::uint32_t session = 0;      ///< from Welcome; 0 before it
  std::uint64_t sequence = 0;     ///< number of the frame in its direction, from 0
  std::int64_t send_time_ns = 0;  ///< sender's monotonic clock
};

/// Bridge to server, first.
struct Hello {
  std::uint16_t version_min = kOldestProtocolVersion;
  std::uint16_t version_max = kProtocolVersion;
  std::uint32_t capabilities = 0;
  std::uint16_t styluses = 1;  ///< how many slots it asks for, >= 1
  bool lockstep = false;       ///< whether it can run on the simulated clock
  std::string name = {};       ///< for the log, at most kNameSize bytes
};

/// Server to bridge: the answer to an accepted Hello.
struct Welcome {
  std::uint16_t version = kProtocolVersion;
  std::uint16_t first_stylus = 0;  ///< the bridge's slots are this one and those that follow
  std::uint32_t capabilities = 0;  ///< those that both sides have
  std::uint32_t session = 0;       ///< goes into every header from here on, > 0
  bool lockstep = false;
  double dt = 0.0;  ///< of the force step [s], > 0
};

enum class RefuseReason : std::uint16_t {
  kVersion = 1,             ///< no common version
  kNoFreeStylus = 2,        ///< all slots in use now
  kTooManyStyluses = 3,     ///< more slots asked for than the server has
  kTooManyConnections = 4,  ///< try again later
  kLockstep = 5,            ///< the server runs in lockstep and the bridge cannot
  kStopping = 6,            ///< the server is about to end
};

/// Server to bridge: the answer to any other Hello, and the end of the connection.
struct Refuse {
  RefuseReason reason = RefuseReason::kVersion;
  std::uint16_t version_min = kOldestProtocolVersion;  ///< of the server
  std::uint16_t version_max = kProtocolVersion;
  std::string text = {};  ///< for a person, at most kTextSize bytes
};

enum class GoodbyeReason : std::uint16_t {
  kFinished = 0,       ///< the work is done
  kStopping = 1,       ///< told to stop
  kProtocolError = 2,  ///< the peer broke the protocol
  kTimeout = 3,        ///< the peer was silent too long
};

/// Either way: the orderly end.
struct Goodbye {
  GoodbyeReason reason = GoodbyeReason::kFinished;
};

/// Bridge to server. Tip and orientation are finite, the orientation has norm 1 within 1e-3.
struct SampleMessage {
  std::uint16_t stylus = 0;  ///< server's slot
  StylusSample sample = {};
};

/// Server to bridge: what step force_step answers to one sample. Force, proxy and torque are
/// finite.
struct ForceMessage {
  std::uint16_t stylus = 0;  ///< server's slot
  StylusForce force = {};
  bool with_torque = false;  ///< exactly where both sides are capable of it; else torque is 0
};

/// Server to bridge, after each step, where both sides are capable of it and not in lockstep: how
/// the contact of a stylus goes on. Finite but for friction; what it says of a contact that is not
/// valid means nothing. To be checked before use: irdm::check().
struct ContactModelMessage {
  std::uint16_t stylus = 0;  ///< server's slot
  ContactModel model = {};
};

/// Bridge to server, after each step that it solved by itself. Finite.
struct AppliedForcesMessage {
  std::uint16_t stylus = 0;  ///< server's slot
  AppliedForces applied = {};
};

/// Median, 99th percentile and maximum [us], none below 0.
struct Quantiles {
  float median = 0;
  float p99 = 0;
  float maximum = 0;
};

/// Bridge to server, about once a second, where both sides are capable of it: what the bridge has
/// measured since the last one.
struct Report {
  std::uint16_t stylus = 0;   ///< server's slot
  Quantiles round_trip = {};  ///< sample taken to its first force received
  Quantiles age = {};         ///< of forces at the moment when a newer one took their place
};

/// Server to bridge, about once a second, where both sides are capable of it and not in lockstep:
/// how the run goes. Counts are since its start, times of the last second.
struct Status {
  std::uint64_t steps = 0;
  std::uint64_t missed = 0;     ///< steps that were skipped because the one before was late
  std::uint64_t unsolved = 0;   ///< steps without a finite solution of the contacts
  std::uint64_t overflows = 0;  ///< steps that did not fit into a queue: deformation, recorder
  Quantiles step_time = {};
  Quantiles wakeup_delay = {};  ///< how late a step began
  float surface_rate = 0;       ///< deformed surfaces [1/s], not below 0
};

/// Server to bridge, after Welcome, where both sides are capable of it and not in lockstep: where
/// samples, applied forces, forces and contact models may go by datagrams.
struct Datagrams {
  std::uint16_t port = 0;                    ///< of UDP, at the server's address, > 0
  std::array<std::uint8_t, 32> random = {};  ///< what the keys are made from, see Stream::derive()
};

using Message = std::variant<Hello, Welcome, Refuse, Goodbye, SampleMessage, ForceMessage, Report,
                             ContactModelMessage, AppliedForcesMessage, Status, Datagrams>;

struct Frame {
  Header header;
  Message message;
};

}  // namespace irdm::wire
