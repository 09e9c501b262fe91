#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/wire/connection.hpp"
#include "device_bridge/link/force_receiver.hpp"
#include "device_bridge/network_client.hpp"
#include "device_bridge/safety/arming.hpp"
#include "device_bridge/servo_link.hpp"

namespace irdm {

/// This one, or where it is null the program's.
spdlog::logger& log_of(const std::shared_ptr<spdlog::logger>& log) noexcept;

/// The bridge's end of a session's datagrams: asks the server's port until a datagram comes back,
/// and gives it up when none does for a while; the stream goes by TCP then. Network thread only.
class ServerDatagrams {
 public:
  /// A path may let through TCP alone; samples and forces go by it meanwhile.
  static constexpr std::int64_t kPatienceNs = 500'000'000;

  /// Begins to ask.
  /// @param connection whose Welcome has come  @param server for messages; outlives this
  /// @param report counts what is dropped; outlives this
  ServerDatagrams(std::shared_ptr<wire::Connection> connection, const wire::Datagrams& offer,
                  const std::string& server, ClientReport& report, std::int64_t now_ns,
                  std::shared_ptr<spdlog::logger> log = nullptr);
  ServerDatagrams(const ServerDatagrams&) = delete;
  ServerDatagrams& operator=(const ServerDatagrams&) = delete;
  ~ServerDatagrams() { close(); }

  /// Asks again, or gives up.
  void check_time(std::int64_t now_ns);
  /// The session is over.
  void close() noexcept;

 private:
  void open(const wire::Datagrams& offer);
  void take(std::span<const std::uint8_t> datagram, const wire::DatagramSocket::Endpoint& from);
  void give_up(const std::string& why);

  std::shared_ptr<wire::Connection> connection_;
  const std::string& server_;
  ClientReport& report_;
  std::shared_ptr<spdlog::logger> log_;
  std::int64_t deadline_ns_;
  bool asking_ = true;
  std::shared_ptr<wire::DatagramSocket> socket_;
};

/// How a session with the server ended.
struct SessionEnd {
  std::string reason = {};    ///< for the log
  bool welcomed = false;      ///< there was one
  bool lockstep = false;      ///< it was in lockstep
  bool server_ended = false;  ///< the server said goodbye to it
  bool refused = false;       ///< for a reason that may pass
  std::string failure = {};   ///< why another attempt makes no sense; empty: it does
};

/// One connection to the server, from Hello to close: samples out, forces in, time limits. Network
/// thread only.
/// Large: the states of one protocol with their time limits; each private method is one message or
/// limit.
class ServerSession {
 public:
  /// What all sessions share; outlives them.
  struct Shared {
    ServoLink& link;
    const ClientSettings& settings;
    const std::string& server;  ///< for messages
    ClientReport& report;
    ArmingPatience& patience;
    /// Called when a session begins or ends; empty: nobody is.
    std::function<void(const LinkState&)> changed = {};
  };

  ServerSession(std::shared_ptr<wire::Connection> connection, const Shared& shared);
  ServerSession(const ServerSession&) = delete;
  ServerSession& operator=(const ServerSession&) = delete;

  /// Says hello.
  /// @param ended called once, when the connection is closed; do not destroy the session in it
  void start(std::function<void(const SessionEnd&)> ended);
  /// Sends the samples that are ready.
  void send_samples();
  /// Applies the time limits.
  void check_time(std::int64_t now_ns);
  /// Says goodbye and waits a while for the server to hang up; closes at once before Welcome.
  void stop(wire::GoodbyeReason reason);

 private:
  enum class State { kGreeting, kLinked, kEnding };

  void receive(const wire::Frame& frame);
  void welcomed(const wire::Welcome& welcome);
  void refused(const wire::Refuse& refuse);
  void take(const wire::ForceMessage& message);
  void take(const wire::ContactModelMessage& message);
  std::size_t ours(std::uint16_t slot) const;
  void take(const wire::Status& status);
  void take(const wire::Datagrams& offer);
  void violated(const wire::ProtocolError& error);
  void closed(const std::string& reason);
  void leave();
  void send_reports(std::int64_t now_ns);
  void tell_of_arming(std::int64_t now_ns);
  void warn_force_reduced();
  void publish();
  void deadline_in(int milliseconds);
  std::uint16_t slot(std::size_t stylus) const noexcept;
  spdlog::logger& log() const noexcept { return log_of(shared_.settings.log); }

  std::shared_ptr<wire::Connection> connection_;
  Shared shared_;
  std::function<void(const SessionEnd&)> ended_;
  State state_ = State::kGreeting;
  LinkState link_state_;
  SessionEnd end_;
  std::int64_t deadline_ns_ = 0;
  std::int64_t answered_ns_ = 0;  ///< when a sample was answered last, or the session began
  std::int64_t silence_ns_ = 0;   ///< longest time without
  std::uint16_t first_stylus_ = 0;
  bool wants_datagrams_ = false;  ///< asked for, and the server has them
  std::unique_ptr<ServerDatagrams> datagrams_;
  bool torques_ = false;  ///< asked for, and the server has them
  bool reports_ = false;  ///< the server takes them
  std::int64_t next_report_ns_ = 0;
  std::vector<ForceReceiver> intakes_;       ///< one a stylus, from Welcome on
  std::vector<bool> warned_of_oscillation_;  ///< the same
  std::vector<bool> warned_of_energy_;       ///< the same
};

}  // namespace irdm
