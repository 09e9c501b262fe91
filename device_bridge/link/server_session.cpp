#include "device_bridge/link/server_session.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "common/realtime/clock.hpp"
#include "device_bridge/safety/arming.hpp"

namespace irdm {

using Endpoint = wire::DatagramSocket::Endpoint;

spdlog::logger& log_of(const std::shared_ptr<spdlog::logger>& log) noexcept {
  return log ? *log : *spdlog::default_logger_raw();
}

ServerDatagrams::ServerDatagrams(std::shared_ptr<wire::Connection> connection,
                                 const wire::Datagrams& offer, const std::string& server,
                                 ClientReport& report, std::int64_t now_ns,
                                 std::shared_ptr<spdlog::logger> log)
    : connection_(std::move(connection)),
      server_(server),
      report_(report),
      log_(std::move(log)),
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
  log_of(log_).info("server {}: the stream goes by UDP", server_);
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
  log_of(log_).warn("server {}: no datagrams: {}; the stream goes by TCP", server_, why);
}

void ServerDatagrams::close() noexcept {
  asking_ = false;
  if (socket_) socket_->close();
}

namespace {

using wire::ProtocolError;
using wire::ProtocolFault;

constexpr std::int64_t kReportPeriodNs = 1000 * kNanosecondsPerMillisecond;
constexpr int kFrameTimeoutMs = 1000;
constexpr int kHangUpMs = 500;
constexpr double kSilentSteps = 5;  // a server of long steps may be silent for so many of them

[[noreturn]] void unexpected(const char* what) {
  throw ProtocolError(ProtocolFault::kUnexpected, what);
}

bool passes(wire::RefuseReason reason) {
  return reason == wire::RefuseReason::kNoFreeStylus ||
         reason == wire::RefuseReason::kTooManyConnections ||
         reason == wire::RefuseReason::kStopping;
}

}  // namespace

ServerSession::ServerSession(std::shared_ptr<wire::Connection> connection, const Shared& shared)
    : connection_(std::move(connection)), shared_(shared) {}

void ServerSession::start(std::function<void(const SessionEnd&)> ended) {
  ended_ = std::move(ended);
  deadline_in(shared_.settings.answer_timeout_ms);
  connection_->start({
      .received = [this](const wire::Frame& frame) { receive(frame); },
      .violated = [this](const ProtocolError& error) { violated(error); },
      .closed = [this](const std::string& reason) { closed(reason); },
  });
  std::uint32_t capabilities = wire::kCapabilityReport | wire::kCapabilityStatus;
  if (shared_.settings.predict) capabilities |= wire::kCapabilityContactModel;
  if (shared_.settings.torque) capabilities |= wire::kCapabilityTorque;
  if (shared_.settings.udp) capabilities |= wire::kCapabilityDatagrams;
  if (shared_.settings.simulated_link) capabilities |= wire::kCapabilitySimulatedLink;
  connection_->send(
      wire::Hello{.capabilities = capabilities,
                  .styluses = static_cast<std::uint16_t>(shared_.link.styluses.size()),
                  .lockstep = shared_.settings.lockstep,
                  .name = shared_.settings.name});
}

void ServerSession::receive(const wire::Frame& frame) {
  const bool linked = state_ == State::kLinked;
  if (const auto* welcome = std::get_if<wire::Welcome>(&frame.message)) {
    if (linked) unexpected("a second Welcome");
    welcomed(*welcome);
  } else if (const auto* refuse = std::get_if<wire::Refuse>(&frame.message)) {
    if (linked) unexpected("a refusal within a session");
    refused(*refuse);
  } else if (std::holds_alternative<wire::Goodbye>(frame.message)) {
    link_state_.server_ended = end_.server_ended = linked;
    log().info("server {}: goodbye", shared_.server);
    leave();
  } else if (const auto* force = std::get_if<wire::ForceMessage>(&frame.message)) {
    if (!linked) unexpected("a force before Welcome");
    if (frame.header.session != connection_->session()) unexpected("a force of another session");
    take(*force);
  } else if (const auto* model = std::get_if<wire::ContactModelMessage>(&frame.message)) {
    if (!linked || !link_state_.predict) unexpected("a contact model that was not asked for");
    if (frame.header.session != connection_->session()) unexpected("a model of another session");
    take(*model);
  } else if (const auto* status = std::get_if<wire::Status>(&frame.message)) {
    if (!linked) unexpected("a status before Welcome");
    take(*status);
  } else if (const auto* offer = std::get_if<wire::Datagrams>(&frame.message)) {
    if (!linked || !wants_datagrams_ || datagrams_) unexpected("a port that was not asked for");
    take(*offer);
  } else {
    unexpected("a message that only a bridge sends");
  }
}

void ServerSession::welcomed(const wire::Welcome& welcome) {
  if (welcome.lockstep && !shared_.settings.lockstep) {
    unexpected("lockstep, which was not offered");
  }
  if (shared_.settings.simulated_link &&
      (welcome.capabilities & wire::kCapabilitySimulatedLink) == 0) {
    end_.failure = shared_.server +
                   ": the server does not run in lockstep, and bridge.link is simulated; start it "
                   "with --lockstep, or remove the table";
    return leave();
  }
  const std::optional<int>& wanted = shared_.settings.first_stylus;
  if (wanted && welcome.first_stylus != *wanted) {
    end_.refused = true;
    return connection_->close("the server gives stylus " + std::to_string(welcome.first_stylus) +
                              ", not " + std::to_string(*wanted));
  }
  state_ = State::kLinked;
  end_.welcomed = true;
  end_.lockstep = welcome.lockstep;
  connection_->set_session(welcome.session);
  first_stylus_ = welcome.first_stylus;
  torques_ = shared_.settings.torque && (welcome.capabilities & wire::kCapabilityTorque) != 0;
  reports_ = (welcome.capabilities & wire::kCapabilityReport) != 0;
  const bool datagrams = (welcome.capabilities & wire::kCapabilityDatagrams) != 0;
  wants_datagrams_ = shared_.settings.udp && datagrams && !welcome.lockstep;
  answered_ns_ = monotonic_ns();
  silence_ns_ = std::max(shared_.settings.silence_timeout_ms * kNanosecondsPerMillisecond,
                         static_cast<std::int64_t>(kSilentSteps * 1e9 * welcome.dt));
  next_report_ns_ = answered_ns_ + kReportPeriodNs;
  link_state_ = {.linked = true,
                 .sessions = ++shared_.report.sessions,
                 .lockstep = welcome.lockstep,
                 .predict = shared_.settings.predict &&
                            (welcome.capabilities & wire::kCapabilityContactModel) != 0,
                 .dt = welcome.dt,
                 .first_stylus = welcome.first_stylus};
  for (ServoLink::Stylus& stylus : shared_.link.styluses) {
    intakes_.emplace_back(welcome.lockstep);
    warned_of_oscillation_.push_back(false);
    warned_of_energy_.push_back(false);
    stylus.sample.receive();  // what was taken before the session is no part of it
    stylus.applied.receive();
  }
  log().info("server {}: session {}, dt {} s{}", shared_.server, welcome.session, welcome.dt,
             welcome.lockstep      ? ", lockstep"
             : link_state_.predict ? ", contact solved here"
                                   : ", forces held");
  if (shared_.settings.udp && !datagrams && !welcome.lockstep) {
    log().warn("server {}: it has no datagrams (server.udp); the stream goes by TCP",
               shared_.server);
  }
  publish();
}

void ServerSession::refused(const wire::Refuse& refuse) {
  end_.refused = passes(refuse.reason);
  if (end_.refused) return connection_->close("refused: " + refuse.text);
  if (refuse.reason == wire::RefuseReason::kVersion) {
    const wire::VersionMismatch mismatch(refuse.version_min, refuse.version_max,
                                         wire::kOldestProtocolVersion, wire::kProtocolVersion);
    end_.failure =
        shared_.server + ": " + mismatch.what() + "; install matching versions of both programs";
  } else {
    end_.failure = shared_.server + ": the server refuses: " + refuse.text +
                   (refuse.reason == wire::RefuseReason::kLockstep
                        ? "; connect in lockstep, a bridge with virtual devices only"
                        : "; change the bridge's devices");
  }
  leave();
}

std::size_t ServerSession::ours(std::uint16_t slot) const {
  const int index = slot - first_stylus_;
  if (index < 0 || index >= static_cast<int>(intakes_.size())) {
    unexpected("an answer for a stylus that is not ours");
  }
  return static_cast<std::size_t>(index);
}

// An invalid model is as good as lost.
void ServerSession::take(const wire::ContactModelMessage& message) {
  const std::size_t stylus = ours(message.stylus);
  const ContactModelFault fault = check(message.model, {.dt = link_state_.dt});
  if (fault != ContactModelFault::kNone) {
    if (shared_.report.models_refused++ == 0) {
      log().error("server {}: step {}: invalid contact model ({}), not used", shared_.server,
                  message.model.step, word(fault));
    }
    return;
  }
  ++shared_.report.models;
  shared_.link.styluses[stylus].model.put({link_state_.sessions, message.model});
}

void ServerSession::take(const wire::ForceMessage& message) {
  if (message.with_torque != torques_) {
    unexpected(torques_ ? "a force without torque" : "a torque that was not asked for");
  }
  const std::size_t stylus = ours(message.stylus);
  const std::int64_t now_ns = monotonic_ns();
  const std::optional<std::uint64_t> before = intakes_[stylus].answered();
  if (!intakes_[stylus].take(message.force, now_ns, shared_.report)) return;
  if (intakes_[stylus].answered() > before) answered_ns_ = now_ns;
  shared_.link.styluses[stylus].input.put(intakes_[stylus].input());
  shared_.link.news.signal();
}

void ServerSession::take(const wire::Status& status) {
  if (!shared_.report.server_at_first) shared_.report.server_at_first = status;
  shared_.report.server = status;
}

void ServerSession::take(const wire::Datagrams& offer) {
  datagrams_ = std::make_unique<ServerDatagrams>(connection_, offer, shared_.server, shared_.report,
                                                 monotonic_ns(), shared_.settings.log);
}

// In lockstep a sample is what the server waits for: all else comes first.
void ServerSession::send_samples() {
  for (std::size_t i = 0; i < intakes_.size(); ++i) {
    TripleBuffer<OfSession<AppliedForces>>& box = shared_.link.styluses[i].applied;
    if (!box.receive() || state_ != State::kLinked || !link_state_.predict) continue;
    if (box.front().session != link_state_.sessions) continue;
    wire::AppliedForcesMessage message{slot(i), box.front().value};
    if (connection_->by_datagrams()) {
      message.applied.count = std::min(message.applied.count, wire::kForcesInDatagram);
    }
    connection_->send_newest(2 * intakes_.size() + i, message);
  }
  for (std::size_t i = 0; i < intakes_.size(); ++i) {
    TripleBuffer<StylusSample>& box = shared_.link.styluses[i].sample;
    if (!box.receive() || state_ != State::kLinked) continue;
    intakes_[i].sent(box.front());
    connection_->send_newest(i, wire::SampleMessage{slot(i), box.front()});
    ++shared_.report.samples;
  }
}

// In lockstep there are no such times.
void ServerSession::send_reports(std::int64_t now_ns) {
  if (!reports_ || link_state_.lockstep || now_ns < next_report_ns_) return;
  next_report_ns_ = now_ns + kReportPeriodNs;
  for (std::size_t i = 0; i < intakes_.size(); ++i) {
    const std::optional<wire::Report> report = intakes_[i].report(slot(i));
    if (report) connection_->send_newest(intakes_.size() + i, *report);
  }
}

// A person who feels nothing, or not for long, should know why.
void ServerSession::tell_of_arming(std::int64_t now_ns) {
  const auto good = [](const ServoLink::Stylus& each) {
    return each.awaits_button || (each.armed && each.success_rate >= LinkGate::kNeeded);
  };
  const std::vector<ServoLink::Stylus>& styluses = shared_.link.styluses;
  const bool all = std::all_of(styluses.begin(), styluses.end(), good);
  if (link_state_.lockstep || !shared_.patience.lost(now_ns, all)) return;
  for (std::size_t i = 0; i < styluses.size(); ++i) {
    if (good(styluses[i])) continue;
    log().warn(
        "stylus {}: {}: {:.0f} % of the last ticks were answered in time, {:.0f} % are needed; "
        "irdm-bridge check-link says more",
        i, styluses[i].armed ? "its force comes and goes" : "no force yet",
        100.0 * styluses[i].success_rate, 100.0 * LinkGate::kNeeded);
  }
}

// Nor should one who feels less than there is be left to guess. Once a session.
void ServerSession::warn_force_reduced() {
  constexpr double kMuchLess = 0.75;
  const auto warn = [&](std::size_t i, double share, std::vector<bool>& warned, const char* why,
                        const char* hint) {
    if (share > kMuchLess || warned[i]) return;
    warned[i] = true;
    log().warn("stylus {}: {}, force scaled to {:.0f} %{}", i, why, 100.0 * share, hint);
  };
  for (std::size_t i = 0; i < shared_.link.styluses.size(); ++i) {
    const ServoLink::Stylus& stylus = shared_.link.styluses[i];
    warn(i, stylus.gain, warned_of_oscillation_, "oscillation detected",
         ", objects feel softer; use bridge.mode = \"predict\", a faster link or a smaller "
         "coupling_stiffness");
    warn(i, stylus.energy_share, warned_of_energy_,
         "its contact gave more energy than hands put in",
         "; it comes back after the contact; use a faster link (irdm-bridge check-link)");
  }
}

void ServerSession::check_time(std::int64_t now_ns) {
  const auto older = [now_ns](std::optional<std::int64_t> since, int limit_ms) {
    return since && now_ns - *since > limit_ms * kNanosecondsPerMillisecond;
  };
  if (older(connection_->partial_since_ns(), kFrameTimeoutMs)) {
    violated(ProtocolError(ProtocolFault::kTruncated, "a message is not complete in time"));
  }
  const bool due = now_ns > deadline_ns_;
  switch (state_) {
    case State::kGreeting:
      if (due) connection_->drop("no answer to Hello");
      break;
    case State::kLinked:
      send_reports(now_ns);
      tell_of_arming(now_ns);
      warn_force_reduced();
      if (datagrams_) datagrams_->check_time(now_ns);
      if (!link_state_.lockstep && now_ns - answered_ns_ > silence_ns_) {
        ++shared_.report.stalls;
        connection_->drop("no answers any more");
      }
      break;
    case State::kEnding:
      if (due) connection_->drop("the server does not hang up");
      break;
  }
}

void ServerSession::stop(wire::GoodbyeReason reason) {
  if (state_ == State::kEnding) return;
  if (state_ == State::kGreeting) return connection_->close("stopped");
  connection_->send(wire::Goodbye{reason});
  leave();
}

void ServerSession::violated(const ProtocolError& error) {
  if (state_ == State::kEnding) return;
  if (error.fault() == ProtocolFault::kWrongVersion) {
    end_.failure =
        shared_.server + ": " + error.what() + "; install matching versions of both programs";
    return leave();
  }
  ++shared_.report.protocol_errors;
  if (error.fault() == ProtocolFault::kWrongMagic && shared_.report.sessions == 0) {
    end_.failure = shared_.server +
                   ": is no irdm-server's port for bridges; give the one that it prints after "
                   "'listening on', not its page's";
    return leave();
  }
  connection_->tell_violation(error);
  log().error("server {}: {}; connection closed", shared_.server, error.what());
  connection_->send(wire::Goodbye{wire::GoodbyeReason::kProtocolError});
  leave();
}

/// Ends the session in order; the connection closes when the server hangs up.
void ServerSession::leave() {
  state_ = State::kEnding;
  deadline_in(kHangUpMs);
  connection_->finish();
  publish();
}

void ServerSession::closed(const std::string& reason) {
  state_ = State::kEnding;
  if (datagrams_) datagrams_->close();
  shared_.patience.pause();
  publish();
  end_.reason = reason;
  if (connection_->refused()) {
    end_.reason = "no TLS with this key: " + reason;
    // Later on it is something on the way that spoils the bytes.
    if (shared_.report.sessions == 0) {
      end_.failure = shared_.server + ": " + end_.reason +
                     "; give bridge and server the same key file (bridge.key_file, "
                     "server.key_file)";
    }
  } else if (!end_.welcomed && !end_.refused && !shared_.settings.key) {
    end_.reason += " (a server that wants a key hangs up on a bridge without bridge.key_file)";
  }
  ended_(end_);
}

void ServerSession::publish() {
  if (!end_.welcomed) return;
  link_state_.linked = state_ == State::kLinked;
  for (std::size_t i = 0; i < intakes_.size(); ++i) {
    if (!link_state_.linked) intakes_[i].end();
    shared_.link.styluses[i].input.put(intakes_[i].input());
  }
  shared_.link.state.put(link_state_);
  if (shared_.changed) shared_.changed(link_state_);
  shared_.link.news.signal();
}

void ServerSession::deadline_in(int milliseconds) {
  deadline_ns_ = monotonic_ns() + milliseconds * kNanosecondsPerMillisecond;
}

std::uint16_t ServerSession::slot(std::size_t stylus) const noexcept {
  return static_cast<std::uint16_t>(first_stylus_ + stylus);
}

}  // namespace irdm
