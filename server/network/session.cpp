#include "server/network/session.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <utility>

#include "common/number_text.hpp"
#include "common/realtime/clock.hpp"

namespace irdm {
namespace {

constexpr double kBurst = 0.25;  // of the frames of a second, at once
constexpr std::int64_t kHangUpNs = 500 * kNanosecondsPerMillisecond;  // for the peer to close

using wire::ProtocolError;
using wire::ProtocolFault;

[[noreturn]] void unexpected(const std::string& what) {
  throw ProtocolError(ProtocolFault::kUnexpected, what);
}

}  // namespace

Session::Session(std::uint32_t id, std::shared_ptr<wire::Connection> connection,
                 const Shared& shared)
    : id_(id),
      connection_(std::move(connection)),
      shared_(shared),
      accepted_ns_(monotonic_ns()),
      frames_(shared.settings.max_frame_rate,
              std::max(1.0, kBurst * shared.settings.max_frame_rate)) {}

void Session::start() {
  connection_->start({
      .received = [this](const wire::Frame& frame) { receive(frame); },
      .violated = [this](const ProtocolError& error) { violated(error); },
      .closed =
          [this](const std::string& reason) {
            if (welcomed_ && !ending_since_ns_) {
              complain("connection lost: " + reason);
            }
            if (connection_->refused()) {
              complain("refused: not the server's key, or no TLS: " + reason);
              shared_.stats.wrong_keys.fetch_add(1);
            }
            shared_.stats.messages_late.fetch_add(connection_->late());
            release();
            over_ = true;
          },
  });
}

void Session::receive(const wire::Frame& frame) {
  if (!shared_.settings.lockstep && !frames_.take(connection_->received_ns())) {
    shared_.stats.too_fast.fetch_add(1);
    unexpected("more messages than " + std::to_string(shared_.settings.max_frame_rate) +
               " a second");
  }
  if (frame.header.session != (welcomed_ ? id_ : 0)) unexpected("a message of another session");
  if (const auto* hello = std::get_if<wire::Hello>(&frame.message)) {
    greet(*hello);
  } else if (!welcomed_) {
    unexpected("a message before Hello");
  } else if (const auto* sample = std::get_if<wire::SampleMessage>(&frame.message)) {
    take(*sample);
  } else if (const auto* report = std::get_if<wire::Report>(&frame.message)) {
    take(*report);
  } else if (const auto* applied = std::get_if<wire::AppliedForcesMessage>(&frame.message)) {
    take(*applied);
  } else if (std::holds_alternative<wire::Goodbye>(frame.message)) {
    spdlog::info("bridge {}: goodbye", connection_->peer());
    // Counted before the styluses go, so that whoever sees them absent knows why.
    shared_.stats.goodbyes.fetch_add(1);
    left_ = true;
    end(wire::GoodbyeReason::kFinished);
  } else {
    unexpected("a message that only a server sends");
  }
}

void Session::greet(const wire::Hello& hello) {
  if (welcomed_) unexpected("a second Hello");
  const NetworkSettings& settings = shared_.settings;
  if (hello.version_min > wire::kProtocolVersion ||
      hello.version_max < wire::kOldestProtocolVersion) {
    throw wire::VersionMismatch(hello.version_min, hello.version_max, wire::kOldestProtocolVersion,
                                wire::kProtocolVersion);
  }
  if (settings.lockstep && !hello.lockstep) {
    return refuse(wire::RefuseReason::kLockstep, "the server runs in lockstep");
  }
  if (hello.styluses > settings.styluses) {
    return refuse(wire::RefuseReason::kTooManyStyluses,
                  "the server has " + styluses_text(static_cast<std::size_t>(settings.styluses)));
  }
  std::uint32_t capabilities = wire::kCapabilityReport | wire::kCapabilityTorque;
  simulated_link_ = (hello.capabilities & wire::kCapabilitySimulatedLink) != 0;
  if (settings.contact_models && (!settings.lockstep || simulated_link_)) {
    capabilities |= wire::kCapabilityContactModel;
  }
  if (settings.lockstep) capabilities |= wire::kCapabilitySimulatedLink;
  if (!settings.lockstep) capabilities |= wire::kCapabilityStatus;
  if (shared_.datagrams != nullptr) capabilities |= wire::kCapabilityDatagrams;
  capabilities &= hello.capabilities;
  predicts_ = (capabilities & wire::kCapabilityContactModel) != 0;
  wants_status_ = (capabilities & wire::kCapabilityStatus) != 0;
  wants_torque_ = (capabilities & wire::kCapabilityTorque) != 0;
  std::optional<int> first = shared_.slots.claim(hello.styluses, predicts_);
  if (!first) {
    shared_.make_room();
    first = shared_.slots.claim(hello.styluses, predicts_);
  }
  if (!first) {
    return refuse(wire::RefuseReason::kNoFreeStylus, "no free stylus: another bridge has it");
  }
  welcomed_ = true;
  first_ = *first;
  count_ = hello.styluses;
  // Counted before it shows, here and elsewhere: whoever sees the effect finds the count.
  shared_.stats.accepted.fetch_add(1);
  connection_->set_session(id_);
  connection_->send(wire::Welcome{.version = std::min(hello.version_max, wire::kProtocolVersion),
                                  .first_stylus = static_cast<std::uint16_t>(first_),
                                  .capabilities = capabilities,
                                  .session = id_,
                                  .lockstep = settings.lockstep,
                                  .dt = settings.dt});
  if ((capabilities & wire::kCapabilityDatagrams) != 0) offer_datagrams();
  spdlog::info("bridge {} ({}): session {}, stylus {} to {}", connection_->peer(), hello.name, id_,
               first_, first_ + count_ - 1);
}

void Session::offer_datagrams() {
  const wire::Datagrams offer{shared_.datagrams->number(), wire::random_material()};
  connection_->use(shared_.datagrams->make_link(connection_->remote_endpoint().address(),
                                                connection_->derive_keys(offer.random), id_));
  connection_->send(offer);
}

void Session::take_datagram(std::span<const std::uint8_t> datagram,
                            const DatagramPort::Endpoint& from) {
  NetworkStats& stats = shared_.stats;
  switch (connection_->take_datagram(datagram, from)) {
    case wire::DatagramVerdict::kForeign:
      stats.datagrams_foreign.fetch_add(1);
      return;
    case wire::DatagramVerdict::kForged:
      stats.datagrams_forged.fetch_add(1);
      return;
    case wire::DatagramVerdict::kReplayed:
      stats.datagrams_replayed.fetch_add(1);
      return;
    case wire::DatagramVerdict::kMessage:
      break;
    case wire::DatagramVerdict::kOpened:  // no message that would count
      if (!ending_since_ns_ && !frames_.take(connection_->received_ns())) {
        stats.too_fast.fetch_add(1);
        violated(ProtocolError(ProtocolFault::kUnexpected, "too many datagrams"));
      }
      break;
  }
  stats.datagrams.fetch_add(1);
}

void Session::take(const wire::SampleMessage& message) {
  if (message.stylus < first_ || message.stylus >= first_ + count_) {
    unexpected("a sample of a stylus that is not its own");
  }
  if (shared_.settings.lockstep) check_lockstep(message);
  if (!shared_.slots.put(message.stylus, message.sample, monotonic_ns())) {
    shared_.stats.samples_old.fetch_add(1);
    throw ProtocolError(ProtocolFault::kBackward, "a sample that is not newer than the last");
  }
  shared_.stats.samples.fetch_add(1);
}

// Sample k is that of time (k + 1) dt. Behind a simulated link it is of when it was sent.
void Session::check_lockstep(const wire::SampleMessage& message) const {
  constexpr std::int64_t kRoundingNs = 1000;
  const std::uint64_t next = shared_.slots.next_sequence(message.stylus);
  const std::uint64_t sequence = message.sample.sequence;
  if (sequence > next) {
    unexpected("sample " + std::to_string(sequence) + " where sample " + std::to_string(next) +
               " is due; in lockstep send one for each step");
  }
  const double time_ns = static_cast<double>(sequence + 1) * shared_.settings.dt * 1e9;
  if (simulated_link_ || std::abs(message.sample.time_ns - std::llround(time_ns)) <= kRoundingNs) {
    return;
  }
  throw ProtocolError(ProtocolFault::kBadValue,
                      "sample " + std::to_string(sequence) + " has the time " +
                          std::to_string(message.sample.time_ns) + " ns; in lockstep it is " +
                          std::to_string(std::llround(time_ns)) + " ns, (sequence + 1) dt");
}

void Session::take(const wire::Report& report) {
  if (report.stylus < first_ || report.stylus >= first_ + count_) {
    unexpected("a report of a stylus that is not its own");
  }
  shared_.slots.port(report.stylus).link.put({true, report});
}

void Session::take(const wire::AppliedForcesMessage& message) {
  if (!predicts_) unexpected("forces that were not asked for");
  if (message.stylus < first_ || message.stylus >= first_ + count_) {
    unexpected("forces of a stylus that is not its own");
  }
  shared_.slots.put(message.stylus, message.applied);
}

void Session::violated(const ProtocolError& error) {
  if (error.fault() == ProtocolFault::kWrongVersion && !welcomed_) {
    return refuse(wire::RefuseReason::kVersion, error.what());
  }
  connection_->tell_violation(error);
  complain(std::string(error.what()) + "; connection closed");
  shared_.stats.protocol_errors.fetch_add(1);
  end(wire::GoodbyeReason::kProtocolError);
}

void Session::refuse(wire::RefuseReason reason, const std::string& text) {
  complain("refused: " + text);
  shared_.stats.refused.fetch_add(1);
  ending_since_ns_ = monotonic_ns();
  connection_->send(wire::Refuse{.reason = reason, .text = text});
  connection_->finish();
  release();
}

void Session::end(wire::GoodbyeReason reason) {
  if (ending_since_ns_) return;
  ending_since_ns_ = monotonic_ns();
  connection_->send(wire::Goodbye{reason});
  connection_->finish();
  release();
}

void Session::release() {
  shared_.slots.release(first_, count_, left_);
  count_ = 0;
}

// In lockstep a force is what the bridge waits for: the model comes first.
void Session::send_forces() {
  for (int slot = first_; predicts_ && slot < first_ + count_; ++slot) send_model(slot);
  for (int slot = first_; slot < first_ + count_; ++slot) {
    std::optional<StylusForce> force = shared_.slots.take_force(slot);
    if (!force) continue;
    if (!force->force.allFinite() || !force->proxy.allFinite() || !force->torque.allFinite()) {
      if (shared_.stats.forces_not_finite.fetch_add(1) == 0) {
        spdlog::error("step {}: the force is not finite; zero is sent", force->force_step);
      }
      force->force.setZero();
      force->proxy.setZero();
      force->torque.setZero();
    }
    const bool replaced = connection_->send_newest(
        static_cast<std::size_t>(slot - first_),
        wire::ForceMessage{static_cast<std::uint16_t>(slot), *force, wants_torque_});
    if (replaced) shared_.stats.forces_replaced.fetch_add(1);
    shared_.stats.forces.fetch_add(1);
  }
}

void Session::send_model(int slot) {
  const ContactModel* const model = shared_.slots.take_model(slot);
  if (model == nullptr) return;
  connection_->send_newest(static_cast<std::size_t>(count_ + slot - first_),
                           wire::ContactModelMessage{static_cast<std::uint16_t>(slot), *model});
}

void Session::yield(std::int64_t now_ns) {
  const NetworkSettings& settings = shared_.settings;
  const std::int64_t silent_ns = now_ns - connection_->received_ns();
  if (!welcomed_ || over_ || ending_since_ns_ || settings.lockstep) return;
  if (silent_ns <= settings.yield_after_ms * kNanosecondsPerMillisecond) return;
  shared_.stats.yielded.fetch_add(1);
  time_out("silent, and another bridge asks for a stylus");
}

void Session::evict() {
  complain("no Hello yet, and another peer asks; connection closed");
  shared_.stats.displaced.fetch_add(1);
  connection_->drop("displaced");
}

void Session::drop() {
  connection_->drop("the peer does not hang up");
}

void Session::time_out(const std::string& what) {
  complain(what + "; connection closed");
  shared_.stats.timeouts.fetch_add(1);
  end(wire::GoodbyeReason::kTimeout);
}

// One who knocks again and again does not fill the disk.
void Session::complain(const std::string& what) {
  if (shared_.complaints.take(monotonic_ns())) {
    spdlog::warn("bridge {}: {}", connection_->peer(), what);
  } else {
    shared_.stats.unlogged.fetch_add(1);
  }
}

void Session::send_status(const wire::Status& status) {
  if (!wants_status_ || count_ == 0) return;
  const auto stream = static_cast<std::size_t>(2 * count_);  // after those of the styluses
  connection_->send_newest(stream, status);
}

void Session::check_time(std::int64_t now_ns) {
  const NetworkSettings& settings = shared_.settings;
  const auto older = [now_ns](std::optional<std::int64_t> since, int limit_ms) {
    return since && now_ns - *since > limit_ms * kNanosecondsPerMillisecond;
  };
  if (over_) return;
  if (ending_since_ns_) {
    if (now_ns - *ending_since_ns_ > kHangUpNs) drop();
  } else if (older(connection_->partial_since_ns(), settings.frame_timeout_ms)) {
    violated(ProtocolError(ProtocolFault::kTruncated, "a message is not complete in time"));
  } else if (!welcomed_) {
    if (older(accepted_ns_, settings.handshake_timeout_ms)) time_out("no Hello in time");
  } else if (!settings.lockstep) {
    if (older(connection_->received_ns(), settings.silence_timeout_ms)) {
      time_out("silent too long");
    } else if (older(connection_->writing_since_ns(), settings.silence_timeout_ms)) {
      time_out("does not read its forces");
    }
  }
}

}  // namespace irdm
