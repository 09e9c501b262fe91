#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/realtime/event_fd.hpp"
#include "common/realtime/scheduling.hpp"
#include "common/wire/datagram_socket.hpp"
#include "common/wire/frame.hpp"
#include "common/wire/secret_key.hpp"
#include "server/network/stylus_slots.hpp"

namespace irdm {

/// The server's UDP port, for the datagrams of all sessions. Network thread only.
class DatagramPort {
 public:
  using Endpoint = wire::DatagramSocket::Endpoint;
  /// A datagram that says it is of a session; never 0.
  using Received = std::function<void(std::uint32_t session, std::span<const std::uint8_t> datagram,
                                      const Endpoint& from)>;

  /// Of the port's number at this address; any free one when `any_port` and that is taken. Throws
  /// boost::system::system_error.
  DatagramPort(const boost::asio::any_io_executor& executor, const Endpoint& local, bool any_port);
  DatagramPort(const DatagramPort&) = delete;
  DatagramPort& operator=(const DatagramPort&) = delete;
  ~DatagramPort() { close(); }

  std::uint16_t number() const { return socket_->local().port(); }
  /// @param received must live until close()
  /// @param foreign called for what is no datagram of ours at all
  void start(Received received, std::function<void()> foreign);
  void close() noexcept { socket_->close(); }
  /// The server's end for a session with a bridge at this address.
  std::unique_ptr<wire::DatagramLink> make_link(const boost::asio::ip::address& bridge,
                                                const wire::DatagramKeys& keys,
                                                std::uint32_t session) const;

 private:
  std::shared_ptr<wire::DatagramSocket> socket_;
};

struct NetworkSettings {
  std::string address = "127.0.0.1";  ///< numeric IPv4 or IPv6 address of this machine
  std::uint16_t port = 0;             ///< 0: any free one
  double dt = 0.002;                  ///< force step [s], (0, 1]
  bool lockstep = false;
  int styluses = 4;                 ///< slots, 1 to 64
  bool contact_models = true;       ///< whether bridges may solve contacts themselves
  int max_connections = 16;         ///< >= 1
  int max_frame_rate = 40000;       ///< of one bridge [1/s], >= 1; not in lockstep
  int handshake_timeout_ms = 1000;  ///< from connection to Hello
  int frame_timeout_ms = 1000;      ///< from the first byte of a frame to its last
  int absent_after_ms = 100;        ///< without a sample the stylus is absent; not in lockstep
  int yield_after_ms = 50;  ///< without a byte a session gives way to who asks; not in lockstep
  RealTimeScheduling scheduling = RealTimeScheduling::kIgnore;
  int silence_timeout_ms = 500;  ///< without a byte the session ends; not in lockstep
  /// What bridges have to know, in TLS; nothing: no TLS, and the address has to be a loopback one.
  std::optional<wire::SecretKey> key = {};
  bool any_datagram_port = false;  ///< UDP may have another number than TCP; always with port 0
  bool udp = true;                 ///< a bridge's stream may go by datagrams; not in lockstep
  wire::FrameTap* tap = nullptr;   ///< listens in, in the network thread; null: nobody
};

/// Counters of the network thread; read from any thread.
struct NetworkStats {
  std::atomic<std::uint64_t> accepted{0};         ///< sessions welcomed
  std::atomic<std::uint64_t> refused{0};          ///< connections refused
  std::atomic<std::uint64_t> displaced{0};        ///< cut before Hello, for another to come in
  std::atomic<std::uint64_t> wrong_keys{0};       ///< connections without the server's key
  std::atomic<std::uint64_t> protocol_errors{0};  ///< connections closed for breaking the protocol
  std::atomic<std::uint64_t> timeouts{0};         ///< connections closed for being silent
  std::atomic<std::uint64_t> yielded{0};          ///< of these, for another bridge to come in
  std::atomic<std::uint64_t> too_fast{0};         ///< connections closed for too many frames
  std::atomic<std::uint64_t> goodbyes{0};         ///< sessions that their bridge ended in order
  std::atomic<std::uint64_t> samples{0};          ///< handed to the force thread
  std::atomic<std::uint64_t> samples_old{0};      ///< not newer than the last: their sessions ended
  std::atomic<std::uint64_t> forces{0};           ///< handed to a connection
  std::atomic<std::uint64_t> forces_replaced{0};  ///< not sent because a newer one was there
  std::atomic<std::uint64_t> forces_not_finite{0};   ///< sent as zero
  std::atomic<std::uint64_t> datagrams{0};           ///< that opened
  std::atomic<std::uint64_t> datagrams_foreign{0};   ///< of no session, or not from its bridge
  std::atomic<std::uint64_t> datagrams_forged{0};    ///< spoilt, or sealed with another key
  std::atomic<std::uint64_t> datagrams_replayed{0};  ///< came before, or much too late
  std::atomic<std::uint64_t> messages_late{0};    ///< dropped: a newer one of their kind had come
  std::atomic<std::uint64_t> internal_errors{0};  ///< caught in the network thread
  std::atomic<std::uint64_t> unlogged{0};         ///< complaints about peers beyond what is logged
};

/// Listens for bridges and relays samples and forces between them and the force thread, on a thread
/// of its own (docs/protocol.md). The force thread touches port(i) and forces_ready()
/// only; all of that is real-time safe, serve() is not. In lockstep the force thread serves the
/// network itself, between its steps: each waits for the other there.
class NetworkServer {
 public:
  /// Binds and listens. Throws Error when it cannot.
  explicit NetworkServer(const NetworkSettings& settings);
  NetworkServer(const NetworkServer&) = delete;
  NetworkServer& operator=(const NetworkServer&) = delete;
  ~NetworkServer();  ///< stops

  /// Where bridges find it, as ADDRESS:PORT, one or more; and the port alone.
  std::vector<std::string> endpoints() const;
  std::uint16_t port_number() const noexcept;

  int styluses() const noexcept;
  StylusPort& port(int stylus);
  /// To be signalled once after the `out` mailboxes of a step were filled, where there is a thread
  /// that waits for it.
  EventFd& forces_ready() noexcept;
  const NetworkStats& stats() const noexcept;
  /// What goes to the bridges soon after it is put in; from one thread.
  TripleBuffer<wire::Status>& status() noexcept;

  /// Starts the thread. Throws Error when real-time scheduling is required and not permitted.
  void start();
  /// In place of start(): no thread, whoever calls serve() does its work.
  void open();
  /// Sends what the `out` mailboxes hold, and does one thing that is to be done; waits for it, at
  /// most 10 ms. After open().
  void serve() noexcept;
  /// Says goodbye to every bridge, waits at most half a second for them to hang up, and joins the
  /// thread, or serves till then. Every stylus is absent afterwards. Further calls do nothing.
  void stop();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace irdm
