#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/wire/asio.hpp"
#include "common/wire/datagram_socket.hpp"
#include "common/wire/frame.hpp"
#include "common/wire/protocol_error.hpp"
#include "common/wire/stream.hpp"

namespace irdm::wire {

/// A TCP connection, perhaps with TLS, that carries frames, on the thread of its io_context.
/// Control messages go out in order and all of them; of the messages of one stream (a stylus, say)
/// only the newest goes out when the peer or the network cannot keep up. Beside it those messages
/// may go by datagrams. It knows no time-out: its owner looks at the ages.
/// Large: one state machine from handshake to close; its members are what both directions need to
/// go on.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  /// Called on the thread of the io_context; what they refer to must live until `closed` returns.
  struct Handlers {
    /// A whole, checked frame. May throw ProtocolError.
    std::function<void(const Frame&)> received;
    /// The stream is not valid or goes backward, or `received` threw. Send a last message and
    /// finish(), or close(); nothing is received any more.
    std::function<void(const ProtocolError&)> violated;
    /// The connection has ended for whatever reason; last call.
    std::function<void(const std::string& reason)> closed;
  };

  /// Takes over a stream that is connected and turns no-delay on.
  /// @param tap listens in; null: nobody. Outlives the connection
  /// @param remote the peer's end where it is known; nothing: asks the socket, which does not know
  /// it any more once the peer has cut the connection
  explicit Connection(std::unique_ptr<Stream> stream, FrameTap* tap = nullptr,
                      const std::optional<boost::asio::ip::tcp::endpoint>& remote = {});
  /// What is sent before the handshake of the stream is done waits for it.
  void start(Handlers handlers);

  /// Goes into the headers of all messages from now on.
  void set_session(std::uint32_t session) noexcept { session_ = session; }
  std::uint32_t session() const noexcept { return session_; }

  /// Sends in order, never dropped.
  void send(const Message& message);
  /// Sends the newest message of a stream; true when it replaced one that still waited.
  /// @param stream small number >= 0
  bool send_newest(std::size_t stream, const Message& message);
  /// The keys of datagrams that belong to this connection, made from what its ends agreed on.
  /// After the handshake. Throws std::runtime_error.
  /// @param random of the message Datagrams
  DatagramKeys derive_keys(const KeyMaterial& random) const;
  /// From here on messages of the stream (is_of_stream()) go this way once it is established, each
  /// at once.
  void use(std::unique_ptr<DatagramLink> datagrams) { datagrams_ = std::move(datagrams); }
  /// Not again. Not to be called out of a handler.
  void use_no_datagrams() noexcept { datagrams_.reset(); }
  /// Whether messages of the stream go by datagrams.
  bool by_datagrams() const noexcept { return datagrams_ && datagrams_->established(); }
  /// Asks for a datagram back.
  void probe() noexcept;
  /// A datagram that says it is of this session. What it holds is received like any other message.
  DatagramVerdict take_datagram(std::span<const std::uint8_t> datagram,
                                const DatagramSocket::Endpoint& from);
  /// Messages that came too late, after a newer one of their kind.
  std::uint64_t late() const noexcept { return late_; }
  /// Both ends of the connection.
  boost::asio::ip::tcp::endpoint local_endpoint() const;
  boost::asio::ip::tcp::endpoint remote_endpoint() const { return remote_; }
  boost::asio::any_io_executor executor() const { return stream_->socket().get_executor(); }

  /// Sends what waits, then ends the sending half and waits for the peer to close; what still
  /// comes is ignored. Before the handshake is done: closes.
  void finish();
  /// Ends it at once; `closed` is called.
  void close(const std::string& reason);
  /// Tells whoever listens in that the peer broke the protocol.
  void tell_violation(const ProtocolError& error) noexcept;
  /// As close(), and what the kernel has not sent yet is thrown away: it must not arrive late.
  void drop(const std::string& reason);

  const std::string& peer() const noexcept { return peer_; }
  bool finishing() const noexcept { return finishing_; }
  /// Whether the handshake of the stream is done.
  bool ready() const noexcept { return ready_; }
  /// Whether that failed for want of a common key, or of TLS at the other end.
  bool refused() const noexcept { return refused_; }
  std::int64_t received_ns() const noexcept {
    return received_ns_;
  }  ///< of the peer's last bytes, or start
  /// When the frame began that is not complete; nothing when there is none.
  std::optional<std::int64_t> partial_since_ns() const noexcept { return partial_since_ns_; }
  /// When the write began that is not complete; nothing when there is none.
  std::optional<std::int64_t> writing_since_ns() const noexcept { return writing_since_ns_; }

 private:
  void on_handshake(const boost::system::error_code& error);
  void read();
  void take(std::span<const std::uint8_t> bytes);
  void check_order(std::uint64_t sequence);
  void hand_on(const Frame& frame);
  void append(const Message& message);
  void write();
  void tell(TapKind kind, std::span<const std::uint8_t> bytes) noexcept;
  void tell(TapKind kind, std::string_view text) noexcept;

  std::unique_ptr<Stream> stream_;
  FrameTap* tap_;
  std::uint32_t number_ = 0;  ///< for whoever listens in
  boost::asio::ip::tcp::endpoint remote_;
  std::string peer_;
  Handlers handlers_;
  FrameReader reader_;
  std::unique_ptr<DatagramLink> datagrams_;
  StreamOrder order_;
  std::uint64_t late_ = 0;
  std::array<std::uint8_t, 4096> incoming_;
  std::vector<Message> control_;                // wait, in order
  std::vector<std::optional<Message>> newest_;  // wait, by stream
  std::vector<std::uint8_t> writing_;
  std::uint32_t session_ = 0;
  std::uint64_t sequence_ = 0;
  std::optional<std::uint64_t> received_sequence_;
  std::int64_t received_ns_ = 0;
  std::optional<std::int64_t> partial_since_ns_;
  std::optional<std::int64_t> writing_since_ns_;
  bool ready_ = false;
  bool refused_ = false;
  bool finishing_ = false;
  bool open_ = true;
};

}  // namespace irdm::wire
