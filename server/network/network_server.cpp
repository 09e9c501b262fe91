#include "server/network/network_server.hpp"

#include <pthread.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <functional>
#include <list>
#include <random>
#include <thread>
#include <utility>

#include "common/error.hpp"
#include "common/number_text.hpp"
#include "common/realtime/clock.hpp"
#include "common/wire/open_endpoints.hpp"
#include "common/wire/tls.hpp"
#include "server/network/session.hpp"

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

using boost::asio::ip::tcp;
using boost::system::error_code;

namespace {

constexpr std::int64_t kAwakeNs = 50'000;
constexpr std::chrono::milliseconds kTick(10);

}  // namespace

class NetworkServer::Impl {
 public:
  explicit Impl(const NetworkSettings& settings)
      : settings_(checked(settings)),
        slots_(settings.styluses),
        acceptor_(io_),
        forces_descriptor_(io_),
        timer_(io_) {
    // Made before any thread logs: the thread sanitizer cannot see the guard inside spdlog.
    spdlog::default_logger();
    if (settings_.key) tls_.emplace(wire::TlsRole::kServer, *settings_.key);
    listen();
    if (settings_.udp && !settings_.lockstep) listen_for_datagrams();
    forces_descriptor_.assign(::dup(forces_ready_.descriptor()));
  }
  ~Impl() { stop(); }

  void open();
  void start();
  void serve() noexcept;
  void stop();
  std::vector<std::string> endpoints() const;

  const NetworkSettings settings_;
  NetworkStats stats_;
  EventFd forces_ready_;
  TripleBuffer<wire::Status> status_;
  StylusSlots slots_;
  std::uint16_t port_ = 0;

 private:
  static const NetworkSettings& checked(const NetworkSettings& settings);
  void listen();
  void listen_for_datagrams();
  void run() noexcept;
  template <class Work>
  bool guarded(const Work& work) noexcept;
  void accept();
  void admit(tcp::socket socket);
  std::unique_ptr<wire::Stream> make_stream(tcp::socket socket);
  void remove_ended();
  bool make_room_for_connection();
  std::uint32_t new_session();
  void make_room();
  void take_datagram(std::uint32_t id, std::span<const std::uint8_t> datagram,
                     const DatagramPort::Endpoint& from);
  void send_forces();
  void await_forces();
  void await_tick();
  void shut_down();

  std::optional<wire::Tls> tls_;
  boost::asio::io_context io_{1};
  tcp::acceptor acceptor_;
  tcp::endpoint peer_;  ///< of the connection that is accepted next
  boost::asio::posix::stream_descriptor forces_descriptor_;
  boost::asio::steady_timer timer_;
  std::optional<DatagramPort> datagrams_;
  std::list<Session> sessions_;
  std::random_device random_;
  TokenBucket complaints_ = complaint_allowance();
  bool accepting_ = false;
  bool opened_ = false;
  bool stopping_ = false;
  std::thread thread_;
};

const NetworkSettings& NetworkServer::Impl::checked(const NetworkSettings& settings) {
  const bool good = std::isfinite(settings.dt) && settings.dt > 0.0 &&
                    settings.dt <= wire::kLongestStep && settings.styluses >= 1 &&
                    settings.styluses <= 64 && settings.max_connections >= 1 &&
                    settings.max_frame_rate >= 1;
  if (!good) throw Error("network", "settings out of range", "see NetworkSettings");
  return settings;
}

void NetworkServer::Impl::listen() {
  const std::string wanted = address_text(settings_.address, settings_.port);
  error_code error;
  const auto address = boost::asio::ip::make_address(settings_.address, error);
  if (error) {
    throw Error(wanted, "is not an address", "give a numeric address of this machine");
  }
  if (!address.is_loopback() && !tls_) {
    throw Error(wanted, "can be reached from other machines, and there is no key",
                "set server.key_file and give bridges the same key (docs/configuration.md), or "
                "listen on 127.0.0.1");
  }
  try {
    const tcp::endpoint endpoint(address, settings_.port);
    acceptor_.open(endpoint.protocol());
    acceptor_.set_option(tcp::acceptor::reuse_address(true));
    acceptor_.bind(endpoint);
    acceptor_.listen();
    port_ = acceptor_.local_endpoint().port();
  } catch (const boost::system::system_error& failure) {
    throw Error(wanted, "cannot listen: " + failure.code().message(),
                "choose another address or port, or end the program that uses it");
  }
}

/// At the same port as TCP, so that a firewall needs one number.
void NetworkServer::Impl::listen_for_datagrams() {
  const bool any_port = settings_.port == 0 || settings_.any_datagram_port;
  try {
    datagrams_.emplace(
        io_.get_executor(),
        DatagramPort::Endpoint(boost::asio::ip::make_address(settings_.address), port_), any_port);
  } catch (const boost::system::system_error& failure) {
    throw Error(endpoints().front(), "cannot listen for datagrams: " + failure.code().message(),
                "choose another port, end the program that uses it, or set server.udp = false");
  }
}

void NetworkServer::Impl::take_datagram(std::uint32_t id, std::span<const std::uint8_t> datagram,
                                        const DatagramPort::Endpoint& from) {
  for (Session& session : sessions_) {
    if (session.id() == id) return session.take_datagram(datagram, from);
  }
  stats_.datagrams_foreign.fetch_add(1);
}

std::vector<std::string> NetworkServer::Impl::endpoints() const {
  return wire::open_endpoints(settings_.address, port_);
}

void NetworkServer::Impl::open() {
  opened_ = true;
  accept();
  if (datagrams_) {
    datagrams_->start([this](auto&&... datagram) { take_datagram(datagram...); },
                      [this] { stats_.datagrams_foreign.fetch_add(1); });
  }
  await_tick();
}

void NetworkServer::Impl::start() {
  open();
  await_forces();
  thread_ = std::thread([this] { run(); });
  ::pthread_setname_np(thread_.native_handle(), "network");
  apply_scheduling(settings_.scheduling, thread_, kNetworkPriority);
}

void NetworkServer::Impl::stop() {
  if (!opened_) return;
  opened_ = false;
  boost::asio::post(io_, [this] { shut_down(); });
  if (thread_.joinable()) {
    thread_.join();
  } else {
    run();
  }
}

void NetworkServer::Impl::run() noexcept {
  while (!guarded([this] { io_.run(); })) {
  }
}

// A virtual processor that went to sleep takes some 35 us to come back: what follows a force at
// once finds this thread awake.
void NetworkServer::Impl::serve() noexcept {
  guarded([this] {
    send_forces();
    const std::int64_t asleep_ns = monotonic_ns() + kAwakeNs;
    while (monotonic_ns() < asleep_ns) {
      if (io_.poll_one() > 0) return;
    }
    io_.run_one_for(kTick);
  });
}

void NetworkServer::Impl::send_forces() {
  for (Session& session : sessions_) session.send_forces();
}

/// False when it has failed.
template <class Work>
bool NetworkServer::Impl::guarded(const Work& work) noexcept {
  try {
    work();
    return true;
  } catch (const std::exception& error) {
    stats_.internal_errors.fetch_add(1);
    spdlog::error("network: {}", error.what());
    return false;
  }
}

void NetworkServer::Impl::accept() {
  accepting_ = true;
  acceptor_.async_accept(peer_, [this](error_code error, tcp::socket socket) {
    accepting_ = false;
    if (stopping_) return;
    if (error) {
      // No descriptor left, say: the next tick tries again.
      spdlog::error("network: cannot accept: {}", error.message());
      return;
    }
    admit(std::move(socket));
    accept();
  });
}

void NetworkServer::Impl::admit(tcp::socket socket) {
  const bool room = make_room_for_connection();
  Session& session = sessions_.emplace_back(
      new_session(),
      std::make_shared<wire::Connection>(make_stream(std::move(socket)), settings_.tap, peer_),
      Session::Shared{settings_, slots_, stats_, complaints_, [this] { make_room(); },
                      datagrams_ ? &*datagrams_ : nullptr});
  session.start();
  if (!room) session.refuse(wire::RefuseReason::kTooManyConnections, "too many connections");
}

/// Whether a further connection fits: peers that say nothing keep no bridge away, the oldest
/// without a Hello goes. Nor do those that do not hang up once their session has ended.
bool NetworkServer::Impl::make_room_for_connection() {
  remove_ended();
  const auto limit = static_cast<std::size_t>(settings_.max_connections);
  const auto first = [this](bool (Session::*is)() const noexcept) {
    return std::find_if(sessions_.begin(), sessions_.end(), std::mem_fn(is));
  };
  const auto ending = static_cast<std::size_t>(
      std::count_if(sessions_.begin(), sessions_.end(), std::mem_fn(&Session::ending)));
  if (ending >= limit) first(&Session::ending)->drop();
  if (sessions_.size() - ending < limit) return true;
  const auto silent = first(&Session::unwelcomed);
  if (silent == sessions_.end()) return false;
  silent->evict();
  return true;
}

std::unique_ptr<wire::Stream> NetworkServer::Impl::make_stream(tcp::socket socket) {
  return tls_ ? tls_->make_stream(std::move(socket)) : wire::make_plain_stream(std::move(socket));
}

/// Where nothing of a session is on the stack.
void NetworkServer::Impl::remove_ended() {
  sessions_.remove_if([](const Session& session) { return session.over(); });
}

// Not to be guessed, so that what is said in one session is worth nothing in another.
std::uint32_t NetworkServer::Impl::new_session() {
  for (;;) {
    const auto id = static_cast<std::uint32_t>(random_());
    const bool taken = std::any_of(sessions_.begin(), sessions_.end(),
                                   [id](const Session& session) { return session.id() == id; });
    if (id != 0 && !taken) return id;
  }
}

void NetworkServer::Impl::make_room() {
  const std::int64_t now_ns = monotonic_ns();
  for (Session& session : sessions_) session.yield(now_ns);
}

void NetworkServer::Impl::await_forces() {
  forces_descriptor_.async_wait(boost::asio::posix::stream_descriptor::wait_read,
                                [this](error_code error) {
                                  if (error || stopping_) return;
                                  forces_ready_.consume();
                                  send_forces();
                                  await_forces();
                                });
}

void NetworkServer::Impl::await_tick() {
  timer_.expires_after(kTick);
  timer_.async_wait([this](error_code) {
    const std::int64_t now_ns = monotonic_ns();
    if (!settings_.lockstep) {
      slots_.expire(now_ns, settings_.absent_after_ms * kNanosecondsPerMillisecond);
    }
    for (Session& session : sessions_) session.check_time(now_ns);
    if (status_.receive()) {
      for (Session& session : sessions_) session.send_status(status_.front());
    }
    remove_ended();
    if (!accepting_ && !stopping_) accept();
    if (!stopping_ || !sessions_.empty()) await_tick();
  });
}

void NetworkServer::Impl::shut_down() {
  send_forces();
  stopping_ = true;
  error_code ignored;
  acceptor_.close(ignored);
  forces_descriptor_.close(ignored);
  if (datagrams_) datagrams_->close();
  for (Session& session : sessions_) session.end(wire::GoodbyeReason::kStopping);
}

NetworkServer::NetworkServer(const NetworkSettings& settings)
    : impl_(std::make_unique<Impl>(settings)) {}
NetworkServer::~NetworkServer() = default;

std::vector<std::string> NetworkServer::endpoints() const {
  return impl_->endpoints();
}
std::uint16_t NetworkServer::port_number() const noexcept {
  return impl_->port_;
}
int NetworkServer::styluses() const noexcept {
  return impl_->slots_.count();
}
StylusPort& NetworkServer::port(int stylus) {
  return impl_->slots_.port(stylus);
}
EventFd& NetworkServer::forces_ready() noexcept {
  return impl_->forces_ready_;
}
TripleBuffer<wire::Status>& NetworkServer::status() noexcept {
  return impl_->status_;
}
const NetworkStats& NetworkServer::stats() const noexcept {
  return impl_->stats_;
}
void NetworkServer::open() {
  impl_->open();
}
void NetworkServer::start() {
  impl_->start();
}
void NetworkServer::serve() noexcept {
  impl_->serve();
}
void NetworkServer::stop() {
  impl_->stop();
}

}  // namespace irdm
