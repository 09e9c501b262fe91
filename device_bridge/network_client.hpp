#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "common/realtime/event_fd.hpp"
#include "common/realtime/histogram.hpp"
#include "common/realtime/scheduling.hpp"
#include "common/wire/frame.hpp"
#include "common/wire/message.hpp"
#include "common/wire/secret_key.hpp"
#include "device_bridge/bridge_config.hpp"
#include "device_bridge/servo_link.hpp"

namespace spdlog {
class logger;
}

namespace irdm {

/// What a bridge's network thread has done, over all sessions.
struct ClientReport {
  std::uint64_t sessions = 0;
  std::uint64_t forces = 0;        ///< received and taken
  std::uint64_t forces_old = 0;    ///< dropped: the last one again, or of before the session
  std::uint64_t gaps = 0;          ///< times that force steps are missing between two forces
  std::uint64_t steps_missed = 0;  ///< force steps missing in all gaps
  std::uint64_t longest_gap = 0;   ///< [steps]
  std::uint64_t samples = 0;       ///< given to a connection
  std::uint64_t protocol_errors = 0;
  std::uint64_t models = 0;          ///< contact models received and taken
  std::uint64_t models_refused = 0;  ///< invalid contact models
  std::uint64_t stalls = 0;  ///< connections closed because samples were not answered any more
  std::uint64_t datagram_sessions = 0;  ///< sessions whose stream went by datagrams
  std::uint64_t datagrams = 0;          ///< received, and the server's
  std::uint64_t datagrams_dropped = 0;  ///< received, and not, or for the second time
  Histogram round_trip;  ///< sample taken to its first force received [ns]; real time only
  Histogram jitter;      ///< how much a round trip differs from the one before [ns]
  std::optional<wire::Status> server_at_first;  ///< what the server said of its run, first
  std::optional<wire::Status> server;           ///< and last
  std::string failure;                          ///< why it gave up, one line; empty: it did not
};

struct ClientSettings {
  ServerAddress server = {};
  std::string name = "irdm-bridge";  ///< for the server's log
  bool lockstep = true;              ///< whether all devices can run on the simulated clock
  bool predict = true;               ///< whether it wants to solve the contact itself
  bool simulated_link = false;       ///< whether it simulates the link; lockstep only
  bool torque = false;               ///< whether it wants torques with the forces
  bool udp = false;                  ///< whether it wants the stream by datagrams
  int connect_timeout_ms = 75;       ///< of one attempt
  int back_off_ms = 20;              ///< from the begin of one attempt to the next, at least
  int refused_ms = 100;              ///< the same after a refusal that may pass
  int answer_timeout_ms = 150;       ///< from Hello to Welcome
  RealTimeScheduling scheduling = RealTimeScheduling::kIgnore;
  /// Without an answer to a newer sample; real time only. At least five steps of the server.
  int silence_timeout_ms = 100;
  /// The server's, for TLS; nothing: no TLS, and the server has to be on this machine.
  std::optional<wire::SecretKey> key = {};
  wire::FrameTap* tap = nullptr;  ///< listens in, in the network thread; null: nobody
  /// Of the server, where its first free ones are not to be taken whichever they are.
  std::optional<int> first_stylus = {};
  std::shared_ptr<spdlog::logger> log = nullptr;  ///< null: the program's
};

/// What a client is at now.
struct ClientProgress {
  LinkState link = {};       ///< as of the newest session
  std::string trouble = {};  ///< why the last attempt or session ended; empty: it goes on
  bool answered = false;     ///< a server has answered, if only to refuse the stylus
  bool gave_up = false;      ///< and there will be no other one
};

/// Connects to the server, and again whenever the connection is lost, and relays samples and
/// forces, on a thread of its own. It gives up when the server refuses for a reason that will not
/// pass (another version, more styluses than it has, lockstep with a real device), and when a
/// lockstep session is lost.
class NetworkClient {
 public:
  /// Resolves the server's name. Throws Error when it cannot.
  /// @param gave_up signalled when it gives up
  NetworkClient(ServoLink& link, const ClientSettings& settings, EventFd& gave_up);
  NetworkClient(const NetworkClient&) = delete;
  NetworkClient& operator=(const NetworkClient&) = delete;
  ~NetworkClient();  ///< stops

  void start();
  /// Says goodbye (finished, or else told to stop), waits at most half a second for the server to
  /// hang up, and joins the thread. Further calls do nothing.
  void stop(bool finished = false);
  /// After stop().
  const ClientReport& report() const noexcept;
  /// The newest; one thread, always the same. Valid until it is called again.
  const ClientProgress& progress() noexcept;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace irdm
