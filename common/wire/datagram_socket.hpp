#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include "common/wire/asio.hpp"

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

}  // namespace irdm::wire
