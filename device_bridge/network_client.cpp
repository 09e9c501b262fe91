#include "device_bridge/network_client.hpp"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "common/error.hpp"
#include "common/realtime/clock.hpp"
#include "common/wire/connection.hpp"

namespace irdm {
namespace {

using boost::asio::ip::tcp;
using boost::system::error_code;
using wire::ProtocolError;
using wire::ProtocolFault;

constexpr std::int64_t kNanosecondsPerMillisecond = 1'000'000;
constexpr int kFrameTimeoutMs = 1000;
constexpr int kHangUpMs = 500;

constexpr std::int64_t kReportPeriodNs = 1000 * kNanosecondsPerMillisecond;

wire::Quantiles quantiles(const Histogram& histogram) {
  const auto microseconds = [](std::int64_t ns) {
    return static_cast<float>(std::max<std::int64_t>(ns, 0)) / 1000.0F;
  };
  return {microseconds(histogram.percentile(0.5)), microseconds(histogram.percentile(0.99)),
          microseconds(histogram.maximum())};
}

bool passes(wire::RefuseReason reason) {
  return reason == wire::RefuseReason::kNoFreeStylus ||
         reason == wire::RefuseReason::kTooManyConnections ||
         reason == wire::RefuseReason::kStopping;
}

}  // namespace

class NetworkClient::Impl {
 public:
  Impl(ServoLink& link, const ClientSettings& settings, Wakeup& gave_up);
  ~Impl() { stop(false); }

  void start();
  void stop(bool finished);

  ClientReport report_;

 private:
  /// kResting: the next attempt is due at deadline_ns_. kGivenUp: there is none.
  enum class State { kResting, kConnecting, kGreeting, kLinked, kEnding, kGivenUp };
  /// What is known of one stylus in this session.
  struct Stylus {
    std::optional<std::uint64_t> first_sample;
    std::uint64_t newest_sample = 0;
    std::optional<std::uint64_t> answered;
    std::optional<std::uint64_t> force_step;
    ServoInput input;
    Histogram round_trip;  ///< this and the next: since the last report [ns]
    Histogram age;
  };

  void run() noexcept;
  void await_samples();
  void await_tick();
  void check_time(std::int64_t now_ns);
  void connect();
  void greet(tcp::socket socket);
  void receive(const wire::Frame& frame);
  void welcomed(const wire::Welcome& welcome);
  void refused(const wire::Refuse& refuse);
  void take(const wire::ForceMessage& message);
  void violated(const ProtocolError& error);
  void lost(const std::string& reason);
  void give_up(const std::string& why);
  void leave(State next);
  void send_samples();
  void send_reports(std::int64_t now_ns);
  void publish();
  void deadline_in(int milliseconds) {
    deadline_ns_ = monotonic_ns() + milliseconds * kNanosecondsPerMillisecond;
  }

  ServoLink& link_;
  ClientSettings settings_;
  Wakeup& gave_up_;
  std::string server_;  ///< for messages
  boost::asio::io_context io_{1};
  tcp::resolver::results_type endpoints_;
  boost::asio::posix::stream_descriptor samples_descriptor_;
  boost::asio::steady_timer timer_;
  std::optional<tcp::socket> connecting_;
  std::shared_ptr<wire::Connection> connection_;
  State state_ = State::kResting;
  LinkState link_state_;
  std::int64_t deadline_ns_ = 0;
  std::int64_t force_ns_ = 0;  ///< when the last force came, or the session began
  std::uint16_t first_stylus_ = 0;
  bool reports_ = false;  ///< the server takes them
  std::int64_t next_report_ns_ = 0;
  std::vector<Stylus> styluses_;
  bool complained_ = false;  ///< about this run of failed attempts
  bool stopping_ = false;
  std::thread thread_;
};

NetworkClient::Impl::Impl(ServoLink& link, const ClientSettings& settings, Wakeup& gave_up)
    : link_(link),
      settings_(settings),
      gave_up_(gave_up),
      server_(settings.server.host + ":" + std::to_string(settings.server.port)),
      samples_descriptor_(io_),
      timer_(io_),
      styluses_(link.styluses.size()) {
  // Made before any thread logs: the thread sanitizer cannot see the guard inside spdlog.
  spdlog::default_logger();
  error_code error;
  endpoints_ =
      tcp::resolver(io_).resolve(settings.server.host, std::to_string(settings.server.port), error);
  if (error) {
    throw Error(server_, "cannot resolve the name: " + error.message(), "check the server's name");
  }
  samples_descriptor_.assign(::dup(link_.samples_ready.descriptor()));
}

void NetworkClient::Impl::start() {
  await_samples();
  await_tick();
  connect();
  thread_ = std::thread([this] { run(); });
  apply_scheduling(settings_.scheduling, thread_, kNetworkPriority);
}

void NetworkClient::Impl::stop(bool finished) {
  if (!thread_.joinable()) return;
  boost::asio::post(io_, [this, finished] {
    stopping_ = true;
    error_code ignored;
    samples_descriptor_.close(ignored);
    if (connecting_) connecting_->close(ignored);
    if (state_ == State::kLinked) {
      connection_->send(wire::Goodbye{finished ? wire::GoodbyeReason::kFinished
                                               : wire::GoodbyeReason::kStopping});
      leave(State::kEnding);
    } else if (connection_ && state_ != State::kEnding) {
      connection_->close("stopped");
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
      spdlog::error("network: {}", error.what());
    }
  }
}

void NetworkClient::Impl::await_samples() {
  samples_descriptor_.async_wait(boost::asio::posix::stream_descriptor::wait_read,
                                 [this](error_code error) {
                                   if (error || stopping_) return;
                                   link_.samples_ready.consume();
                                   send_samples();
                                   await_samples();
                                 });
}

void NetworkClient::Impl::await_tick() {
  constexpr std::chrono::milliseconds kTick(5);
  timer_.expires_after(kTick);
  timer_.async_wait([this](error_code) {
    check_time(monotonic_ns());
    if (!stopping_ || connection_) await_tick();
  });
}

void NetworkClient::Impl::check_time(std::int64_t now_ns) {
  const auto older = [now_ns](std::optional<std::int64_t> since, int limit_ms) {
    return since && now_ns - *since > limit_ms * kNanosecondsPerMillisecond;
  };
  error_code ignored;
  if (connection_ && older(connection_->partial_since_ns(), kFrameTimeoutMs)) {
    violated(ProtocolError(ProtocolFault::kTruncated, "a message is not complete in time"));
  }
  const bool due = now_ns > deadline_ns_;
  switch (state_) {
    case State::kResting:
      if (due && !stopping_) connect();
      break;
    case State::kConnecting:
      if (due && connecting_) connecting_->close(ignored);
      break;
    case State::kGreeting:
      if (due) connection_->close("no answer to Hello");
      break;
    case State::kLinked:
      send_reports(now_ns);
      if (!link_state_.lockstep && older(force_ns_, settings_.silence_timeout_ms)) {
        connection_->close("no force any more");
      }
      break;
    case State::kEnding:
    case State::kGivenUp:
      if (due && connection_) connection_->close("the server does not hang up");
      break;
  }
}

void NetworkClient::Impl::connect() {
  state_ = State::kConnecting;
  deadline_in(settings_.connect_timeout_ms);
  connecting_.emplace(io_);
  boost::asio::async_connect(*connecting_, endpoints_,
                             [this](error_code error, const tcp::endpoint&) {
                               tcp::socket socket = std::move(*connecting_);
                               connecting_.reset();
                               if (stopping_) return;
                               if (error) return lost(error.message());
                               greet(std::move(socket));
                             });
}

void NetworkClient::Impl::greet(tcp::socket socket) {
  state_ = State::kGreeting;
  deadline_in(settings_.answer_timeout_ms);
  connection_ = std::make_shared<wire::Connection>(std::move(socket));
  connection_->start({
      .received = [this](const wire::Frame& frame) { receive(frame); },
      .violated = [this](const ProtocolError& error) { violated(error); },
      .closed = [this](const std::string& reason) { lost(reason); },
  });
  connection_->send(wire::Hello{.capabilities = wire::kCapabilityReport,
                                .styluses = static_cast<std::uint16_t>(styluses_.size()),
                                .lockstep = settings_.lockstep,
                                .name = settings_.name});
}

void NetworkClient::Impl::receive(const wire::Frame& frame) {
  const auto unexpected = [](const char* what) {
    throw ProtocolError(ProtocolFault::kUnexpected, what);
  };
  const bool linked = state_ == State::kLinked;
  if (const auto* welcome = std::get_if<wire::Welcome>(&frame.message)) {
    if (linked) unexpected("a second Welcome");
    welcomed(*welcome);
  } else if (const auto* refuse = std::get_if<wire::Refuse>(&frame.message)) {
    if (linked) unexpected("a refusal within a session");
    refused(*refuse);
  } else if (std::holds_alternative<wire::Goodbye>(frame.message)) {
    link_state_.server_ended = linked;
    spdlog::info("server {}: goodbye", server_);
    leave(State::kEnding);
  } else if (const auto* force = std::get_if<wire::ForceMessage>(&frame.message)) {
    if (!linked) unexpected("a force before Welcome");
    if (frame.header.session != connection_->session()) unexpected("a force of another session");
    take(*force);
  } else {
    unexpected("a message that only a bridge sends");
  }
}

void NetworkClient::Impl::welcomed(const wire::Welcome& welcome) {
  if (welcome.lockstep && !settings_.lockstep) {
    throw ProtocolError(ProtocolFault::kUnexpected, "lockstep, which was not offered");
  }
  state_ = State::kLinked;
  complained_ = false;
  connection_->set_session(welcome.session);
  first_stylus_ = welcome.first_stylus;
  reports_ = (welcome.capabilities & wire::kCapabilityReport) != 0;
  next_report_ns_ = monotonic_ns() + kReportPeriodNs;
  force_ns_ = monotonic_ns();
  ++report_.sessions;
  link_state_ = {
      .linked = true, .sessions = report_.sessions, .lockstep = welcome.lockstep, .dt = welcome.dt};
  for (std::size_t i = 0; i < styluses_.size(); ++i) {
    styluses_[i] = Stylus{};
    styluses_[i].input.linked = true;
    link_.styluses[i].sample.receive();  // what was taken before the session is no part of it
  }
  spdlog::info("server {}: session {}, dt {} s{}", server_, welcome.session, welcome.dt,
               welcome.lockstep ? ", lockstep" : "");
  publish();
}

void NetworkClient::Impl::refused(const wire::Refuse& refuse) {
  if (refuse.reason == wire::RefuseReason::kVersion) {
    const wire::VersionMismatch mismatch(refuse.version_min, refuse.version_max,
                                         wire::kOldestProtocolVersion, wire::kProtocolVersion);
    give_up(server_ + ": " + mismatch.what() + "; install matching versions of both programs");
  } else if (passes(refuse.reason)) {
    connection_->close("refused: " + refuse.text);
  } else {
    give_up(server_ + ": the server refuses: " + refuse.text + "; change the bridge's devices");
  }
}

void NetworkClient::Impl::take(const wire::ForceMessage& message) {
  const int index = message.stylus - first_stylus_;
  if (index < 0 || index >= static_cast<int>(styluses_.size())) {
    throw ProtocolError(ProtocolFault::kUnexpected, "a force for a stylus that is not ours");
  }
  Stylus& stylus = styluses_[static_cast<std::size_t>(index)];
  const StylusForce& force = message.force;
  // A run that is paused answers newer samples in the step where it stands.
  const bool newer =
      !stylus.force_step || force.force_step > *stylus.force_step ||
      (force.force_step == *stylus.force_step && force.sample_sequence > stylus.answered);
  const bool ours = stylus.first_sample && force.sample_sequence >= *stylus.first_sample &&
                    force.sample_sequence <= stylus.newest_sample;
  if (!newer || !ours) {
    ++report_.forces_old;
    return;
  }
  const std::int64_t now_ns = monotonic_ns();
  force_ns_ = now_ns;
  ++report_.forces;
  if (stylus.force_step && force.force_step > *stylus.force_step + 1) {
    const std::uint64_t gap = force.force_step - *stylus.force_step - 1;
    ++report_.gaps;
    report_.steps_missed += gap;
    report_.longest_gap = std::max(report_.longest_gap, gap);
  }
  stylus.force_step = force.force_step;
  // Several steps may answer the same sample; only the first of them is its round trip.
  if (!link_state_.lockstep && (!stylus.answered || force.sample_sequence > *stylus.answered)) {
    report_.round_trip.add(now_ns - force.sample_time_ns);
    stylus.round_trip.add(now_ns - force.sample_time_ns);
  }
  if (stylus.input.any_force) stylus.age.add(now_ns - stylus.input.force.sample_time_ns);
  stylus.answered = force.sample_sequence;
  stylus.input.any_force = true;
  stylus.input.force = force;
  link_.styluses[static_cast<std::size_t>(index)].input.put(stylus.input);
  link_.news.signal();
}

void NetworkClient::Impl::send_samples() {
  for (std::size_t i = 0; i < styluses_.size(); ++i) {
    if (!link_.styluses[i].sample.receive() || state_ != State::kLinked) continue;
    const StylusSample& sample = link_.styluses[i].sample.front();
    Stylus& stylus = styluses_[i];
    if (!stylus.first_sample) stylus.first_sample = sample.sequence;
    stylus.newest_sample = sample.sequence;
    const auto slot = static_cast<std::uint16_t>(first_stylus_ + i);
    connection_->send_newest(i, wire::SampleMessage{slot, sample});
    ++report_.samples;
  }
}

// In lockstep there are no such times.
void NetworkClient::Impl::send_reports(std::int64_t now_ns) {
  if (!reports_ || link_state_.lockstep || now_ns < next_report_ns_) return;
  next_report_ns_ = now_ns + kReportPeriodNs;
  for (std::size_t i = 0; i < styluses_.size(); ++i) {
    Stylus& stylus = styluses_[i];
    if (stylus.round_trip.count() == 0) continue;
    const auto slot = static_cast<std::uint16_t>(first_stylus_ + i);
    connection_->send_newest(styluses_.size() + i, wire::Report{slot, quantiles(stylus.round_trip),
                                                                quantiles(stylus.age)});
    stylus.round_trip = Histogram{};
    stylus.age = Histogram{};
  }
}

void NetworkClient::Impl::violated(const ProtocolError& error) {
  if (state_ == State::kGivenUp || state_ == State::kEnding) return;
  if (error.fault() == ProtocolFault::kWrongVersion) {
    return give_up(server_ + ": " + error.what() + "; install matching versions of both programs");
  }
  ++report_.protocol_errors;
  spdlog::error("server {}: {}; connection closed", server_, error.what());
  connection_->send(wire::Goodbye{wire::GoodbyeReason::kProtocolError});
  leave(State::kEnding);
}

/// Ends the session in order; the connection closes when the server hangs up.
void NetworkClient::Impl::leave(State next) {
  state_ = next;
  deadline_in(kHangUpMs);
  connection_->finish();
  link_state_.linked = false;
  publish();
}

/// The attempt failed or the connection has ended.
void NetworkClient::Impl::lost(const std::string& reason) {
  const bool was_linked = state_ == State::kLinked;
  const bool was_lockstep = link_state_.lockstep && link_state_.sessions > 0;
  if (connection_) {  // it is still on the stack
    boost::asio::post(io_, [connection = std::exchange(connection_, nullptr)] {});
  }
  link_state_.linked = false;
  publish();
  if (state_ == State::kGivenUp) return;
  if (!complained_ && !stopping_) {
    spdlog::warn("server {}: {}: {}; trying again", server_,
                 was_linked ? "connection lost" : "no connection", reason);
    complained_ = true;
  }
  if (was_lockstep && !stopping_) {
    if (!link_state_.server_ended) {
      report_.failure = server_ + ": connection lost in lockstep: " + reason +
                        "; the run cannot be continued, start both again";
    }
    state_ = State::kGivenUp;
    gave_up_.signal();
    return;
  }
  state_ = State::kResting;
  deadline_in(settings_.back_off_ms);
}

void NetworkClient::Impl::give_up(const std::string& why) {
  report_.failure = why;
  leave(State::kGivenUp);
  gave_up_.signal();
}

void NetworkClient::Impl::publish() {
  for (std::size_t i = 0; i < styluses_.size(); ++i) {
    styluses_[i].input.linked = link_state_.linked;
    link_.styluses[i].input.put(styluses_[i].input);
  }
  link_.state.put(link_state_);
  link_.news.signal();
}

NetworkClient::NetworkClient(ServoLink& link, const ClientSettings& settings, Wakeup& gave_up)
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

}  // namespace irdm
