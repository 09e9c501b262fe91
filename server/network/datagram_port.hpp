#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include "common/wire/datagram_socket.hpp"

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

}  // namespace irdm
