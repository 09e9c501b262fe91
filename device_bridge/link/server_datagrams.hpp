#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "common/wire/connection.hpp"
#include "device_bridge/network_client.hpp"

namespace irdm {

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
                  const std::string& server, ClientReport& report, std::int64_t now_ns);
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
  std::int64_t deadline_ns_;
  bool asking_ = true;
  std::shared_ptr<wire::DatagramSocket> socket_;
};

}  // namespace irdm
