#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "common/wire/connection.hpp"
#include "common/wire/token_bucket.hpp"
#include "server/network/network_server.hpp"
#include "server/network/stylus_slots.hpp"

namespace irdm {

/// One bridge's connection, from accept to close: handshake, samples in, forces out, limits.
/// Network thread only.
class Session {
 public:
  /// What all sessions share; outlives them.
  struct Shared {
    const NetworkSettings& settings;
    StylusSlots& slots;
    NetworkStats& stats;
    TokenBucket& complaints;            ///< lines of the log about peers
    std::function<void()> make_room;    ///< ends the sessions that yield
    DatagramPort* datagrams = nullptr;  ///< null: everything goes by TCP
  };

  Session(std::uint32_t id, std::shared_ptr<wire::Connection> connection, const Shared& shared);
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  std::uint32_t id() const noexcept { return id_; }
  /// A datagram that says it is of this session.
  void take_datagram(std::span<const std::uint8_t> datagram, const DatagramPort::Endpoint& from);
  /// Starts to receive.
  void start();
  /// Answers with a refusal instead of a session.
  void refuse(wire::RefuseReason reason, const std::string& text);
  /// Says goodbye and gives its styluses back.
  void end(wire::GoodbyeReason reason);
  /// Ends it when its bridge is silent: another one asks for a stylus.
  void yield(std::int64_t now_ns);
  /// Cuts a connection whose peer has not said Hello: another one has come.
  void evict();
  /// Cuts a connection that has ended without waiting for its peer.
  void drop();
  /// Sends the forces that are ready.
  void send_forces();
  /// Where the bridge wants it.
  void send_status(const wire::Status& status);
  /// Applies the time limits.
  void check_time(std::int64_t now_ns);

  /// True once the connection has ended and the session may be removed.
  bool over() const noexcept { return over_; }
  /// True until its peer's Hello was answered.
  bool unwelcomed() const noexcept { return !welcomed_ && !over_ && !ending_since_ns_; }
  /// True from its end until its peer has hung up.
  bool ending() const noexcept { return ending_since_ns_ && !over_; }

 private:
  void receive(const wire::Frame& frame);
  void greet(const wire::Hello& hello);
  void offer_datagrams();
  void take(const wire::SampleMessage& message);
  void check_lockstep(const wire::SampleMessage& message) const;
  void take(const wire::Report& report);
  void take(const wire::AppliedForcesMessage& message);
  void send_model(int slot);
  void violated(const wire::ProtocolError& error);
  void time_out(const std::string& what);
  void complain(const std::string& what);
  void release();

  std::uint32_t id_;
  std::shared_ptr<wire::Connection> connection_;
  Shared shared_;
  std::int64_t accepted_ns_;
  TokenBucket frames_;
  std::optional<std::int64_t> ending_since_ns_;
  bool welcomed_ = false;
  bool predicts_ = false;  ///< contact models go out, applied forces come in
  bool over_ = false;
  bool left_ = false;  ///< its bridge said goodbye
  bool wants_status_ = false;
  bool wants_torque_ = false;
  bool simulated_link_ = false;
  int first_ = 0;  ///< its slots
  int count_ = 0;
};

}  // namespace irdm
