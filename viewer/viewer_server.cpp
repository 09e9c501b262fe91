#include "viewer/viewer_server.hpp"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <limits>
#include <list>
#include <thread>
#include <vector>

#include "common/error.hpp"
#include "common/realtime/clock.hpp"
#include "common/wire/open_endpoints.hpp"
#include "common/wire/token_bucket.hpp"
#include "viewer/connection.hpp"
#include "viewer/notice_text.hpp"
#include "viewer/viewer_session.hpp"

namespace irdm::viewer {

using boost::asio::ip::tcp;
using boost::system::error_code;

namespace {
constexpr int kTicks = 5;  // of the timer between two messages of health
}  // namespace

class ViewerServer::Impl final : public Hub {
 public:
  Impl(ViewerSettings settings, ViewerSession& run)
      : settings_(std::move(settings)),
        run_(run),
        sources_(run.sources()),
        acceptor_(io_),
        timer_(io_),
        stylus_(run, settings_.stylus_timeout_ms * kNanosecondsPerMillisecond) {
    spdlog::default_logger();  // made before any thread logs, as in the network server
    listen();
    for (const SurfaceSource& source : sources_) {
      descriptors_.emplace_back(io_, ::dup(source.ready.descriptor()));
    }
    scene_ = std::make_shared<const Bytes>(encode(run_.scene()));
    state_ = common_state();
  }
  ~Impl() override { stop(); }

  void start();
  void stop();
  std::vector<std::string> urls() const;

  const ViewerSettings& settings() const override { return settings_; }
  std::size_t objects() const override { return run_.scene().objects.size(); }
  bool has_room() const override;
  SharedBytes scene() override { return scene_; }
  SharedBytes newest_frame() override;
  SharedBytes newest_health() override;
  SharedBytes newest_state(const Connection& viewer) override;
  void handle(const Command& command) override;
  void handle(const SettingsRequest& request) override;
  void handle(const StylusRequest& request, const Connection& viewer) override;
  void handle(const SceneRequest& request) override;
  void complain(const std::string& what) override;

  std::uint16_t port_ = 0;
  std::atomic<std::uint32_t> viewers_{0};
  std::atomic<std::uint64_t> unlogged_{0};

 private:
  void listen();
  void run() noexcept;
  void accept();
  void admit(tcp::socket socket);
  bool make_room();
  template <typename Use>
  void for_each_watching(const Use& use);
  void await_surface(std::size_t source);
  void await_tick();
  void spread_state();
  void spread_new_state();
  State common_state();
  void tidy();
  void shut_down();
  void await_end(std::int64_t deadline_ns);

  ViewerSettings settings_;
  ViewerSession& run_;
  std::vector<SurfaceSource> sources_;
  boost::asio::io_context io_{1};
  tcp::acceptor acceptor_;
  std::list<boost::asio::posix::stream_descriptor> descriptors_;  ///< of the sources
  boost::asio::steady_timer timer_;  ///< for the ticks, and at last for the end
  SharedBytes scene_;
  SharedBytes frame_;  ///< of the newest surface; null: not encoded yet
  std::size_t frame_source_ = 0;
  StylusHolder stylus_;
  State state_;  ///< that all were told last
  int ticks_ = 0;
  TokenBucket complaints_ = complaint_allowance();
  /// They keep themselves alive; what is gone, is over.
  std::vector<std::weak_ptr<Connection>> connections_;
  bool accepting_ = false;
  bool stopping_ = false;
  std::thread thread_;
};

void ViewerServer::Impl::listen() {
  const std::string wanted = shortened(settings_.address) + ":" + std::to_string(settings_.port);
  error_code error;
  const auto address = boost::asio::ip::make_address(settings_.address, error);
  if (error) throw Error("viewer " + wanted, "is not an address", "give a numeric address");
  if (!address.is_loopback() && settings_.token.empty()) {
    throw Error(
        "viewer " + wanted, "can be reached from elsewhere and has no token",
        "set viewer.token_file, and make that file with: (umask 077; openssl rand -hex 16 > FILE)");
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

std::vector<std::string> ViewerServer::Impl::urls() const {
  std::vector<std::string> urls;
  for (const std::string& endpoint : wire::open_endpoints(settings_.address, port_)) {
    urls.push_back("http://" + endpoint);
  }
  return urls;
}

void ViewerServer::Impl::start() {
  accept();
  for (std::size_t source = 0; source < sources_.size(); ++source) await_surface(source);
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
  if (connections_.size() >= settings_.max_connections && !make_room()) {
    complain("refused one connection too many");
    return;  // closes it
  }
  const std::shared_ptr<Connection> connection = make_connection(std::move(socket), *this);
  connections_.push_back(connection);
  connection->start();
}

// Ends the connection that has been silent for the longest time, unless all of them watch.
bool ViewerServer::Impl::make_room() {
  auto silent = connections_.end();
  std::int64_t since_ns = std::numeric_limits<std::int64_t>::max();
  for (auto each = connections_.begin(); each != connections_.end(); ++each) {
    const auto connection = each->lock();
    if (!connection || connection->watching() || connection->heard_ns() >= since_ns) continue;
    since_ns = connection->heard_ns();
    silent = each;
  }
  if (silent == connections_.end()) return false;
  complain("too many connections that say nothing; the oldest of them closed");
  if (const auto connection = silent->lock()) connection->abort();
  connections_.erase(silent);
  return true;
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
  const auto watching =
      std::count_if(connections_.begin(), connections_.end(), [](const auto& weak) {
        const auto connection = weak.lock();
        return connection && connection->watching();
      });
  return static_cast<std::size_t>(watching) < settings_.max_viewers;
}

SharedBytes ViewerServer::Impl::newest_frame() {
  const std::size_t shown = run_.shown_source();
  if (sources_[shown].surfaces.receive() || shown != frame_source_) frame_ = nullptr;
  frame_source_ = shown;
  if (!frame_) {
    auto bytes = std::make_shared<Bytes>();
    encode(sources_[shown].surfaces.front(), *bytes);
    frame_ = std::move(bytes);
  }
  return frame_;
}

SharedBytes ViewerServer::Impl::newest_health() {
  tidy();
  Health health = run_.health();
  health.viewers = viewers_.load(std::memory_order_relaxed);
  return std::make_shared<const Bytes>(encode(health));
}

SharedBytes ViewerServer::Impl::newest_state(const Connection& viewer) {
  State state = state_;
  state.looks_on = viewer.looks_on();
  state.holds_stylus = stylus_.held_by(&viewer);
  return std::make_shared<const Bytes>(encode(state));
}

void ViewerServer::Impl::handle(const Command& command) {
  run_.handle(command);
  spread_state();
}

void ViewerServer::Impl::handle(const SettingsRequest& request) {
  run_.handle(request);
  spread_state();
}

void ViewerServer::Impl::handle(const StylusRequest& request, const Connection& viewer) {
  if (!run_.scene().viewer_stylus) return;
  if (stylus_.take(request, &viewer, monotonic_ns())) spread_state();
}

void ViewerServer::Impl::handle(const SceneRequest& request) {
  run_.handle(request);
  spread_state();
}

void ViewerServer::Impl::complain(const std::string& what) {
  if (complaints_.take(monotonic_ns())) {
    spdlog::warn("viewer: {}", what);
  } else {
    unlogged_.fetch_add(1, std::memory_order_relaxed);
  }
}

template <typename Use>
void ViewerServer::Impl::for_each_watching(const Use& use) {
  for (const auto& weak : connections_) {
    const auto connection = weak.lock();
    if (connection && connection->watching()) use(*connection);
  }
}

State ViewerServer::Impl::common_state() {
  State state = run_.state();
  state.stylus_free = run_.scene().viewer_stylus && stylus_.free();
  state.notice = file_names_only(state.notice);
  return state;
}

void ViewerServer::Impl::spread_new_state() {
  if (common_state() != state_) spread_state();
}

void ViewerServer::Impl::spread_state() {
  state_ = common_state();
  for_each_watching([this](Connection& viewer) { viewer.offer_state(newest_state(viewer)); });
}

void ViewerServer::Impl::await_surface(std::size_t source) {
  const auto descriptor = std::next(descriptors_.begin(), static_cast<std::ptrdiff_t>(source));
  descriptor->async_wait(
      boost::asio::posix::stream_descriptor::wait_read, [this, source](error_code error) {
        if (error) return;
        sources_[source].ready.consume();
        if (source == run_.shown_source()) {
          for_each_watching([this](Connection& viewer) { viewer.offer_frame(newest_frame()); });
        }
        if (!stopping_) await_surface(source);
      });
}

void ViewerServer::Impl::await_tick() {
  constexpr std::chrono::microseconds kMillisecond(1000);
  timer_.expires_after(settings_.health_period_ms * kMillisecond / kTicks);
  timer_.async_wait([this](error_code error) {
    if (error || stopping_) return;
    const std::int64_t now_ns = monotonic_ns();
    for (const auto& weak : connections_) {
      if (const auto connection = weak.lock()) connection->check_time(now_ns);
    }
    stylus_.expire(now_ns, [this](const void* holder) {
      bool there = false;
      for_each_watching([&](const Connection& viewer) { there = there || &viewer == holder; });
      return there;
    });
    if (++ticks_ % kTicks == 0) {
      const SharedBytes health = newest_health();
      for_each_watching([&](Connection& viewer) { viewer.offer_health(health); });
    }
    spread_new_state();
    if (!accepting_) accept();
    await_tick();
  });
}

void ViewerServer::Impl::shut_down() {
  constexpr std::int64_t kHangUpNs = 500'000'000;
  stopping_ = true;
  error_code ignored;
  acceptor_.close(ignored);
  for (auto& descriptor : descriptors_) descriptor.close(ignored);
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

ViewerServer::ViewerServer(ViewerSettings settings, ViewerSession& run)
    : impl_(std::make_unique<Impl>(std::move(settings), run)) {}
ViewerServer::~ViewerServer() = default;

std::vector<std::string> ViewerServer::urls() const {
  return impl_->urls();
}
std::uint16_t ViewerServer::port() const noexcept {
  return impl_->port_;
}
std::uint32_t ViewerServer::viewers() const noexcept {
  return impl_->viewers_.load(std::memory_order_relaxed);
}
std::uint64_t ViewerServer::unlogged() const noexcept {
  return impl_->unlogged_.load(std::memory_order_relaxed);
}
void ViewerServer::start() {
  impl_->start();
}
void ViewerServer::stop() {
  impl_->stop();
}

}  // namespace irdm::viewer
