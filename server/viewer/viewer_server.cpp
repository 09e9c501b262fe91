#include "server/viewer/viewer_server.hpp"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <sstream>
#include <thread>
#include <vector>

#include "common/error.hpp"
#include "common/realtime/clock.hpp"
#include "server/viewer/connection.hpp"

namespace irdm::viewer {

using boost::asio::ip::tcp;
using boost::system::error_code;

class ViewerServer::Impl final : public Hub {
 public:
  Impl(ViewerSettings settings, ViewerFeed feed)
      : settings_(std::move(settings)),
        feed_(std::move(feed)),
        acceptor_(io_),
        surface_descriptor_(io_),
        timer_(io_) {
    spdlog::default_logger();  // made before any thread logs, as in the network server
    listen();
    surface_descriptor_.assign(::dup(feed_.surface_ready.descriptor()));
    scene_ = std::make_shared<const Bytes>(encode(feed_.scene));
  }
  ~Impl() override { stop(); }

  void start();
  void stop();
  std::string url() const;

  const ViewerSettings& settings() const override { return settings_; }
  bool has_room() const override;
  SharedBytes scene() override { return scene_; }
  SharedBytes newest_frame() override;
  SharedBytes newest_health() override;
  void put_back() override { feed_.put_back(); }

  std::uint16_t port_ = 0;
  std::atomic<std::uint32_t> viewers_{0};

 private:
  void listen();
  void run() noexcept;
  void accept();
  void admit(tcp::socket socket);
  void await_surface();
  void await_tick();
  void tidy();
  void shut_down();
  void await_end(std::int64_t deadline_ns);

  ViewerSettings settings_;
  ViewerFeed feed_;
  boost::asio::io_context io_{1};
  tcp::acceptor acceptor_;
  boost::asio::posix::stream_descriptor surface_descriptor_;
  boost::asio::steady_timer timer_;  ///< for the ticks, and at last for the end
  SharedBytes scene_;
  SharedBytes frame_;  ///< of the newest surface; null: not encoded yet
  /// They keep themselves alive; what is gone, is over.
  std::vector<std::weak_ptr<Connection>> connections_;
  bool accepting_ = false;
  bool stopping_ = false;
  std::thread thread_;
};

void ViewerServer::Impl::listen() {
  const std::string wanted = settings_.address + ":" + std::to_string(settings_.port);
  error_code error;
  const auto address = boost::asio::ip::make_address(settings_.address, error);
  if (error) throw Error("viewer " + wanted, "is not an address", "give a numeric address");
  if (!address.is_loopback() && settings_.token.empty()) {
    throw Error("viewer " + wanted, "can be reached from elsewhere and has no token",
                "set viewer.token, for instance to what this prints: openssl rand -hex 16");
  }
  try {
    const tcp::endpoint endpoint(address, settings_.port);
    acceptor_.open(endpoint.protocol());
    acceptor_.set_option(tcp::acceptor::reuse_address(true));
    acceptor_.bind(endpoint);
    acceptor_.listen();
    port_ = acceptor_.local_endpoint().port();
  } catch (const boost::system::system_error& failure) {
    throw Error("viewer " + wanted, "cannot listen: " + failure.code().message(),
                "choose another viewer.address or viewer.port, or start with --no-viewer");
  }
}

std::string ViewerServer::Impl::url() const {
  std::ostringstream text;
  text << "http://" << tcp::endpoint(boost::asio::ip::make_address(settings_.address), port_);
  return text.str();
}

void ViewerServer::Impl::start() {
  accept();
  await_surface();
  await_tick();
  thread_ = std::thread([this] { run(); });
}

void ViewerServer::Impl::stop() {
  if (!thread_.joinable()) return;
  boost::asio::post(io_, [this] { shut_down(); });
  thread_.join();
  viewers_.store(0, std::memory_order_relaxed);
}

void ViewerServer::Impl::run() noexcept {
  for (;;) {
    try {
      io_.run();
      return;
    } catch (const std::exception& error) {
      spdlog::error("viewer: {}", error.what());
    }
  }
}

void ViewerServer::Impl::accept() {
  accepting_ = true;
  acceptor_.async_accept([this](error_code error, tcp::socket socket) {
    accepting_ = false;
    if (stopping_) return;
    if (error) {
      // No descriptor left, say: the next tick tries again.
      spdlog::error("viewer: cannot accept: {}", error.message());
      return;
    }
    admit(std::move(socket));
    accept();
  });
}

void ViewerServer::Impl::admit(tcp::socket socket) {
  tidy();
  if (connections_.size() >= settings_.max_connections) return;  // closes it
  const std::shared_ptr<Connection> connection = make_connection(std::move(socket), *this);
  connections_.push_back(connection);
  connection->start();
}

void ViewerServer::Impl::tidy() {
  std::erase_if(connections_, [](const auto& connection) { return connection.expired(); });
  viewers_.store(static_cast<std::uint32_t>(std::count_if(connections_.begin(), connections_.end(),
                                                          [](const auto& weak) {
                                                            const auto connection = weak.lock();
                                                            return connection &&
                                                                   connection->watching();
                                                          })),
                 std::memory_order_relaxed);
}

bool ViewerServer::Impl::has_room() const {
  const auto open = std::count_if(connections_.begin(), connections_.end(), [](const auto& weak) {
    const auto connection = weak.lock();
    return connection && connection->upgraded();
  });
  return static_cast<std::size_t>(open) < settings_.max_viewers;
}

SharedBytes ViewerServer::Impl::newest_frame() {
  if (feed_.surfaces.receive()) frame_ = nullptr;
  if (!frame_) {
    auto bytes = std::make_shared<Bytes>();
    encode(feed_.surfaces.front(), *bytes);
    frame_ = std::move(bytes);
  }
  return frame_;
}

SharedBytes ViewerServer::Impl::newest_health() {
  tidy();
  Health health = feed_.health();
  health.viewers = viewers_.load(std::memory_order_relaxed);
  return std::make_shared<const Bytes>(encode(health));
}

void ViewerServer::Impl::await_surface() {
  surface_descriptor_.async_wait(boost::asio::posix::stream_descriptor::wait_read,
                                 [this](error_code error) {
                                   if (error) return;
                                   feed_.surface_ready.consume();
                                   for (const auto& weak : connections_) {
                                     const auto connection = weak.lock();
                                     if (connection && connection->watching())
                                       connection->offer_frame(newest_frame());
                                   }
                                   if (!stopping_) await_surface();
                                 });
}

void ViewerServer::Impl::await_tick() {
  timer_.expires_after(std::chrono::milliseconds(settings_.health_period_ms));
  timer_.async_wait([this](error_code error) {
    if (error || stopping_) return;
    const SharedBytes health = newest_health();
    for (const auto& weak : connections_) {
      const auto connection = weak.lock();
      if (!connection) continue;
      connection->check_time(monotonic_ns());
      if (connection->watching()) connection->offer_health(health);
    }
    if (!accepting_) accept();
    await_tick();
  });
}

void ViewerServer::Impl::shut_down() {
  constexpr std::int64_t kHangUpNs = 500'000'000;
  stopping_ = true;
  error_code ignored;
  acceptor_.close(ignored);
  surface_descriptor_.close(ignored);
  const SharedBytes last = newest_frame();
  for (const auto& weak : connections_) {
    const auto connection = weak.lock();
    if (!connection) continue;
    if (connection->watching()) connection->offer_frame(last);
    connection->finish();
  }
  await_end(monotonic_ns() + kHangUpNs);
}

// Nothing but connections and this timer keeps the loop running now.
void ViewerServer::Impl::await_end(std::int64_t deadline_ns) {
  tidy();
  if (connections_.empty()) return;
  if (monotonic_ns() > deadline_ns) {
    for (const auto& weak : connections_) {
      if (const auto connection = weak.lock()) connection->abort();
    }
    return;
  }
  constexpr std::chrono::milliseconds kPause(5);
  timer_.expires_after(kPause);
  timer_.async_wait([this, deadline_ns](error_code) { await_end(deadline_ns); });
}

ViewerServer::ViewerServer(ViewerSettings settings, ViewerFeed feed)
    : impl_(std::make_unique<Impl>(std::move(settings), std::move(feed))) {}
ViewerServer::~ViewerServer() = default;

std::string ViewerServer::url() const {
  return impl_->url();
}
std::uint16_t ViewerServer::port() const noexcept {
  return impl_->port_;
}
std::uint32_t ViewerServer::viewers() const noexcept {
  return impl_->viewers_.load(std::memory_order_relaxed);
}
void ViewerServer::start() {
  impl_->start();
}
void ViewerServer::stop() {
  impl_->stop();
}

}  // namespace irdm::viewer
