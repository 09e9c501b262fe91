#include "device_bridge/link/server_datagrams.hpp"

#include <spdlog/spdlog.h>

#include <utility>

namespace irdm {

using Endpoint = wire::DatagramSocket::Endpoint;

ServerDatagrams::ServerDatagrams(std::shared_ptr<wire::Connection> connection,
                                 const wire::Datagrams& offer, const std::string& server,
                                 ClientReport& report, std::int64_t now_ns)
    : connection_(std::move(connection)),
      server_(server),
      report_(report),
      deadline_ns_(now_ns + kPatienceNs) {
  try {
    open(offer);
    connection_->probe();
  } catch (const boost::system::system_error& error) {
    give_up(error.code().message());
  }
}

/// From the address that the server knows the bridge by.
void ServerDatagrams::open(const wire::Datagrams& offer) {
  const Endpoint server(connection_->remote_endpoint().address(), offer.port);
  socket_ = std::make_shared<wire::DatagramSocket>(
      connection_->executor(), Endpoint(connection_->local_endpoint().address(), 0));
  socket_->connect(server);
  connection_->use(
      std::make_unique<wire::DatagramLink>(socket_, server, connection_->derive_keys(offer.random),
                                           wire::DatagramEnd::kBridge, connection_->session()));
  socket_->start([this](std::span<const std::uint8_t> datagram, const Endpoint& from) {
    take(datagram, from);
  });
}

void ServerDatagrams::take(std::span<const std::uint8_t> datagram, const Endpoint& from) {
  switch (connection_->take_datagram(datagram, from)) {
    case wire::DatagramVerdict::kForeign:
    case wire::DatagramVerdict::kForged:
    case wire::DatagramVerdict::kReplayed:
      ++report_.datagrams_dropped;
      return;
    case wire::DatagramVerdict::kOpened:
    case wire::DatagramVerdict::kMessage:
      ++report_.datagrams;
      break;
  }
  if (!asking_ || !connection_->by_datagrams()) return;
  asking_ = false;
  ++report_.datagram_sessions;
  spdlog::info("server {}: the stream goes by UDP", server_);
}

void ServerDatagrams::check_time(std::int64_t now_ns) {
  if (!asking_) return;
  if (now_ns < deadline_ns_) return connection_->probe();
  give_up("no datagram comes back");
}

void ServerDatagrams::give_up(const std::string& why) {
  asking_ = false;
  close();
  connection_->use_no_datagrams();
  spdlog::warn("server {}: no datagrams: {}; the stream goes by TCP", server_, why);
}

void ServerDatagrams::close() noexcept {
  asking_ = false;
  if (socket_) socket_->close();
}

}  // namespace irdm
