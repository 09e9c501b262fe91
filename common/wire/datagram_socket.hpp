#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>

#include "common/wire/asio.hpp"
#include "common/wire/datagram_channel.hpp"
#include "common/wire/frame.hpp"

namespace irdm::wire {

/// A UDP socket, on the thread of its io_context. It queues nothing: what the kernel does not take
/// at once is lost, as on the way.
class DatagramSocket : public std::enable_shared_from_this<DatagramSocket> {
 public:
  using Endpoint = boost::asio::ip::udp::endpoint;
  using Received = std::function<void(std::span<const std::uint8_t>, const Endpoint& from)>;

  /// Throws boost::system::system_error when the address cannot be had.
  DatagramSocket(const boost::asio::any_io_executor& executor, const Endpoint& local);

  Endpoint local() const { return socket_.local_endpoint(); }
  /// From here on only what comes from there is received. Throws boost::system::system_error.
  void connect(const Endpoint& peer) { socket_.connect(peer); }
  /// @param received called for each datagram until close(); must live until then
  void start(Received received);
  /// False when the kernel does not take it.
  bool send(std::span<const std::uint8_t> datagram, const Endpoint& to) noexcept;
  void close() noexcept;

 private:
  void wait();
  void receive();

  boost::asio::ip::udp::socket socket_;
  Received received_;
  std::array<std::uint8_t, 2048> incoming_{};  // longer ones are cut, and nobody's
  bool open_ = true;
};

/// The datagrams between the two ends of a session. A bridge asks by probes until one comes back,
/// and sends frames from then on; a server answers probes, and sends frames from the first frame on
/// that has come: so each way is known to work before anything depends on it. On the thread of the
/// socket.
class DatagramLink {
 public:
  /// @param peer its port is 0 where it is not known yet: that of the newest datagram that opens
  DatagramLink(std::shared_ptr<DatagramSocket> socket, const DatagramSocket::Endpoint& peer,
               const DatagramKeys& keys, DatagramEnd end, std::uint32_t session);

  /// Whatever the bytes are; answers a probe. Throws ProtocolError for what opens and is not right.
  DatagramVerdict receive(std::span<const std::uint8_t> datagram,
                          const DatagramSocket::Endpoint& from);
  /// After kMessage: what has come, and its bytes; until the next receive().
  const Frame& frame() const { return *frame_; }
  std::span<const std::uint8_t> bytes() const noexcept { return assembly_.bytes(); }

  /// Whether frames can be sent.
  bool established() const noexcept { return established_; }
  void send(std::span<const std::uint8_t> frame) noexcept;
  void probe() noexcept;
  /// Datagrams that the kernel did not take.
  std::uint64_t unsent() const noexcept { return unsent_; }

 private:
  void send_text(std::span<const std::uint8_t> text) noexcept;

  std::shared_ptr<DatagramSocket> socket_;
  DatagramSocket::Endpoint peer_;
  DatagramEnd end_;
  DatagramChannel channel_;
  FrameAssembly assembly_;
  std::optional<Frame> frame_;
  bool established_ = false;
  std::uint64_t unsent_ = 0;
};

}  // namespace irdm::wire
