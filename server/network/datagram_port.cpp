#include "server/network/datagram_port.hpp"

#include <utility>

namespace irdm {
namespace {

std::shared_ptr<wire::DatagramSocket> open(const boost::asio::any_io_executor& executor,
                                           const DatagramPort::Endpoint& local, bool any_port) {
  try {
    return std::make_shared<wire::DatagramSocket>(executor, local);
  } catch (const boost::system::system_error&) {
    if (!any_port) throw;
    return std::make_shared<wire::DatagramSocket>(executor,
                                                  DatagramPort::Endpoint(local.address(), 0));
  }
}

}  // namespace

DatagramPort::DatagramPort(const boost::asio::any_io_executor& executor, const Endpoint& local,
                           bool any_port)
    : socket_(open(executor, local, any_port)) {}

void DatagramPort::start(Received received, std::function<void()> foreign) {
  socket_->start([received = std::move(received), foreign = std::move(foreign)](
                     std::span<const std::uint8_t> datagram, const Endpoint& from) {
    const std::uint32_t session = wire::session_of(datagram);
    if (session == 0) return foreign();
    received(session, datagram, from);
  });
}

std::unique_ptr<wire::DatagramLink> DatagramPort::make_link(const boost::asio::ip::address& bridge,
                                                            const wire::DatagramKeys& keys,
                                                            std::uint32_t session) const {
  return std::make_unique<wire::DatagramLink>(socket_, Endpoint(bridge, 0), keys,
                                              wire::DatagramEnd::kServer, session);
}

}  // namespace irdm
