#include "device_bridge/network_client.hpp"

#include <pthread.h>
#include <spdlog/spdlog.h>
#include <unistd.h>
#include <algorithm>
#include <chrono>
#include <exception>
#include <optional>
#include <thread>
#include <utility>

#include "common/error.hpp"
#include "common/number_text.hpp"
#include "common/realtime/clock.hpp"
#include "common/realtime/triple_buffer.hpp"
#include "common/wire/tls.hpp"
#include "device_bridge/link/server_session.hpp"

namespace irdm {

using boost::asio::ip::tcp;
using boost::system::error_code;

// Between attempts to reach a server that has not been there yet. One that was lost comes back at
// once, or a hand waits.
constexpr int kLongestBackOffMs = 500;

class NetworkClient::Impl {
 public:
  Impl(ServoLink& link, const ClientSettings& settings, EventFd& gave_up);
  ~Impl() { stop(false); }

  void start();
  void stop(bool finished);

  const ClientProgress& progress() noexcept {
    newest_.receive();
    return newest_.front();
  }

  ClientReport report_;

 private:
  void run() noexcept;
  void await_samples();
  void await_tick();
  void check_time(std::int64_t now_ns);
  void connect();
  void greet(tcp::socket socket);
  std::unique_ptr<wire::Stream> make_stream(tcp::socket socket);
  void linked(const LinkState& link);
  void ended(const SessionEnd& end);
  void rest(int milliseconds, const std::string& what, const std::string& reason);
  void give_up(const std::string& why);
  spdlog::logger& log() const noexcept { return log_of(settings_.log); }

  ServoLink& link_;
  const ClientSettings settings_;
  EventFd& gave_up_;
  const std::string server_;  ///< for messages
  ArmingPatience patience_;
  std::optional<wire::Tls> tls_;
  boost::asio::io_context io_{1};
  tcp::resolver::results_type endpoints_;
  boost::asio::posix::stream_descriptor samples_descriptor_;
  boost::asio::steady_timer timer_;
  // At most one of these two; neither while it rests until the next attempt, or gave up.
  std::optional<tcp::socket> connecting_;
  std::unique_ptr<ServerSession> session_;
  std::int64_t began_ns_ = 0;     ///< the last attempt
  std::int64_t deadline_ns_ = 0;  ///< of the attempt to connect, or of the rest after it
  bool complained_ = false;       ///< about this run of failed attempts
  int back_off_ms_;               ///< grows until the first session
  bool stopping_ = false;         ///< told to, or gave up
  ClientProgress progress_;       ///< the network thread's
  TripleBuffer<ClientProgress> newest_;
  std::thread thread_;
};

NetworkClient::Impl::Impl(ServoLink& link, const ClientSettings& settings, EventFd& gave_up)
    : link_(link),
      settings_(settings),
      gave_up_(gave_up),
      server_(address_text(settings.server.host, settings.server.port)),
      samples_descriptor_(io_),
      timer_(io_),
      back_off_ms_(settings.back_off_ms) {
  // Made before any thread logs: the thread sanitizer cannot see the guard inside spdlog.
  spdlog::default_logger();
  error_code error;
  endpoints_ =
      tcp::resolver(io_).resolve(settings.server.host, std::to_string(settings.server.port), error);
  if (error) {
    throw Error(server_, "cannot resolve the name: " + error.message(), "check the server's name");
  }
  if (settings_.key) {
    tls_.emplace(wire::TlsRole::kClient, *settings_.key);
  } else if (!std::all_of(endpoints_.begin(), endpoints_.end(), [](const auto& entry) {
               return entry.endpoint().address().is_loopback();
             })) {
    throw Error(server_, "is not on this machine, and there is no key",
                "set bridge.key_file to a copy of the server's (docs/configuration.md)");
  }
  samples_descriptor_.assign(::dup(link_.samples_ready.descriptor()));
}

void NetworkClient::Impl::start() {
  await_samples();
  await_tick();
  connect();
  thread_ = std::thread([this] { run(); });
  ::pthread_setname_np(thread_.native_handle(), "network");
  apply_scheduling(settings_.scheduling, thread_, kNetworkPriority);
}

void NetworkClient::Impl::stop(bool finished) {
  if (!thread_.joinable()) return;
  boost::asio::post(io_, [this, finished] {
    stopping_ = true;
    error_code ignored;
    samples_descriptor_.close(ignored);
    if (connecting_) connecting_->close(ignored);
    if (session_) {
      session_->stop(finished ? wire::GoodbyeReason::kFinished : wire::GoodbyeReason::kStopping);
    }
  });
  thread_.join();
}

void NetworkClient::Impl::run() noexcept {
  for (;;) {
    try {
      io_.run();
      return;
    } catch (const std::exception& error) {
      log().error("network: {}", error.what());
    }
  }
}

void NetworkClient::Impl::await_samples() {
  samples_descriptor_.async_wait(boost::asio::posix::stream_descriptor::wait_read,
                                 [this](error_code error) {
                                   if (error || stopping_) return;
                                   link_.samples_ready.consume();
                                   if (session_) session_->send_samples();
                                   await_samples();
                                 });
}

void NetworkClient::Impl::await_tick() {
  constexpr std::chrono::milliseconds kTick(5);
  timer_.expires_after(kTick);
  timer_.async_wait([this](error_code) {
    check_time(monotonic_ns());
    if (!stopping_ || session_) await_tick();
  });
}

void NetworkClient::Impl::check_time(std::int64_t now_ns) {
  if (session_) return session_->check_time(now_ns);
  if (now_ns <= deadline_ns_) return;
  error_code ignored;
  if (connecting_) {
    connecting_->close(ignored);
  } else if (!stopping_) {
    connect();
  }
}

void NetworkClient::Impl::connect() {
  began_ns_ = monotonic_ns();
  deadline_ns_ = began_ns_ + settings_.connect_timeout_ms * kNanosecondsPerMillisecond;
  connecting_.emplace(io_);
  boost::asio::async_connect(
      *connecting_, endpoints_, [this](error_code error, const tcp::endpoint&) {
        tcp::socket socket = std::move(*connecting_);
        connecting_.reset();
        if (stopping_) return;
        if (error) {
          return rest(settings_.back_off_ms, "no connection", error.message());
        }
        greet(std::move(socket));
      });
}

void NetworkClient::Impl::greet(tcp::socket socket) {
  session_ = std::make_unique<ServerSession>(
      std::make_shared<wire::Connection>(make_stream(std::move(socket)), settings_.tap),
      ServerSession::Shared{link_, settings_, server_, report_, patience_,
                            [this](const LinkState& link) { linked(link); }});
  session_->start([this](const SessionEnd& end) { ended(end); });
}

std::unique_ptr<wire::Stream> NetworkClient::Impl::make_stream(tcp::socket socket) {
  return tls_ ? tls_->make_stream(std::move(socket)) : wire::make_plain_stream(std::move(socket));
}

void NetworkClient::Impl::linked(const LinkState& link) {
  progress_.link = link;
  if (link.linked) progress_.trouble.clear();
  newest_.put(progress_);
}

void NetworkClient::Impl::ended(const SessionEnd& end) {
  // It is still on the stack.
  boost::asio::post(
      io_, [session = std::shared_ptr<ServerSession>(std::exchange(session_, nullptr))] {});
  if (stopping_) return;
  if (!end.failure.empty()) return give_up(end.failure);
  if (end.lockstep) {
    return give_up(end.server_ended ? ""
                                    : server_ + ": connection lost in lockstep: " + end.reason +
                                          "; the run cannot be continued, start both again");
  }
  complained_ = complained_ && !end.welcomed;
  progress_.answered = progress_.answered || end.refused || end.welcomed;
  rest(end.refused ? settings_.refused_ms : settings_.back_off_ms,
       end.welcomed ? "connection lost" : "no connection", end.reason);
}

/// @param milliseconds from the begin of the last attempt to the next
void NetworkClient::Impl::rest(int milliseconds, const std::string& what,
                               const std::string& reason) {
  if (!complained_) log().warn("server {}: {}: {}; trying again", server_, what, reason);
  complained_ = true;
  progress_.trouble = what + ": " + reason;
  newest_.put(progress_);
  if (report_.sessions == 0) {
    milliseconds = std::max(milliseconds, back_off_ms_);
    back_off_ms_ = std::max(back_off_ms_, std::min(2 * back_off_ms_, kLongestBackOffMs));
  }
  deadline_ns_ = began_ns_ + milliseconds * kNanosecondsPerMillisecond;
}

void NetworkClient::Impl::give_up(const std::string& why) {
  report_.failure = why;
  progress_.trouble = why;
  progress_.gave_up = true;
  newest_.put(progress_);
  stopping_ = true;
  gave_up_.signal();
}

NetworkClient::NetworkClient(ServoLink& link, const ClientSettings& settings, EventFd& gave_up)
    : impl_(std::make_unique<Impl>(link, settings, gave_up)) {}
NetworkClient::~NetworkClient() = default;
void NetworkClient::start() {
  impl_->start();
}
void NetworkClient::stop(bool finished) {
  impl_->stop(finished);
}
const ClientReport& NetworkClient::report() const noexcept {
  return impl_->report_;
}
const ClientProgress& NetworkClient::progress() noexcept {
  return impl_->progress();
}

}  // namespace irdm
