#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "common/realtime/histogram.hpp"
#include "device_bridge/haply/inverse_mailbox.hpp"
#include "device_bridge/haply/inverse_messages.hpp"
#include "device_bridge/haply/trouble_text.hpp"

namespace irdm::haply {

/// How long the service took to answer, and what went wrong.
struct InverseReport {
  std::uint64_t answers = 0;
  double sum = 0.0;           ///< from a message to its answer, of all [s]
  Histogram round_trip = {};  ///< the same [ns]
  std::uint64_t bad_messages = 0;
  std::uint64_t reconnects = 0;
};

/// In words.
std::string to_text(const InverseReport& report);

/// Whom forces are exchanged with, and how.
struct ExchangePartner {
  std::string device = {};  ///< id
  std::string grip = {};    ///< id; empty: the first in a message
  ForceKey key = ForceKey::kValues;
};

/// Forces to a device against states of it: what is to be sent when, and what a state means. Zero
/// is sent where the device is not ready, the force is old or goes with an earlier generation, or
/// the service's answer is late. Knows no socket and no thread; the time is an argument,
/// monotonic_ns(). One thread, the mailbox's network side.
class InverseExchange {
 public:
  InverseExchange(InverseMailbox& mailbox, TroubleText& trouble, InverseReport& report)
      : mailbox_(mailbox), trouble_(trouble), report_(report) {}

  /// On a new connection: nothing that was sent before is answered.
  void connect() noexcept { sent_ns_.clear(); }
  /// The first message to this device on a connection, without force. Its emergency brake counts as
  /// it was told last, on whatever connection.
  /// @param status as the service told, if it did
  std::string begin(const ExchangePartner& partner, const std::optional<InverseStatus>& status);

  /// The message that is due; none: an answer is waited for. Late ones are not waited for: what was
  /// sent last would stay on.
  std::optional<std::string> next(std::int64_t now_ns);
  /// The last one.
  std::string last() const { return encode_force(partner_.device, Vector3::Zero(), partner_.key); }
  /// A message goes out. The service gives each one answer.
  void sent(std::int64_t now_ns) { sent_ns_.push_back(now_ns); }
  void answered(std::int64_t now_ns);
  bool all_answered() const noexcept { return sent_ns_.empty(); }

  /// A state with a tip.
  void take(const InverseDevice& device, const std::vector<VerseGrip>& grips, std::int64_t now_ns);
  /// No force until the next state of a device that is ready.
  void withhold();
  /// The emergency brake is engaged, or released: no force until it is.
  void lock(bool engaged);

 private:
  void judge();
  Vector3 newest_force(std::int64_t now_ns);

  InverseMailbox& mailbox_;
  TroubleText& trouble_;
  InverseReport& report_;
  ExchangePartner partner_;
  std::optional<InverseStatus> status_;  ///< told last
  bool locked_ = false;
  InverseReading reading_;
  std::deque<std::int64_t> sent_ns_;  ///< of messages without an answer yet
};

}  // namespace irdm::haply
