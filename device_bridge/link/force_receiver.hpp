#pragma once

#include <cstdint>
#include <optional>

#include "common/realtime/histogram.hpp"
#include "common/wire/message.hpp"
#include "device_bridge/network_client.hpp"
#include "device_bridge/servo_link.hpp"

namespace irdm {

/// The forces of one stylus in one session: which of them are news, and how old they are. Pure.
class ForceReceiver {
 public:
  /// @param lockstep times of samples are simulated: nothing is measured
  explicit ForceReceiver(bool lockstep) : lockstep_(lockstep) { input_.linked = true; }

  /// A sample goes out.
  void sent(const StylusSample& sample) noexcept;
  /// A force has come. False when it is dropped: it is the last one again, or answers a sample of
  /// before this session. Throws ProtocolError for one that goes backward or answers what was not
  /// said.
  bool take(const StylusForce& force, std::int64_t now_ns, ClientReport& report);
  /// The session is over.
  void end() noexcept { input_.linked = false; }

  /// Sequence of the newest sample that was answered.
  std::optional<std::uint64_t> answered() const noexcept { return answered_; }
  /// For the servo thread.
  const ServoInput& input() const noexcept { return input_; }
  /// What was measured since the last call; nothing when no force came.
  /// @param slot the server's number of the stylus
  std::optional<wire::Report> report(std::uint16_t slot) noexcept;

 private:
  void check_order(const StylusForce& force) const;
  void check_time(const StylusForce& force, std::int64_t now_ns) const;
  bool news(const StylusForce& force) const noexcept;
  void measure(std::int64_t round_trip_ns, ClientReport& report) noexcept;
  void count_gap(std::uint64_t step, ClientReport& report) noexcept;

  bool lockstep_;
  std::optional<std::uint64_t> first_sample_;
  std::uint64_t newest_sample_ = 0;
  std::optional<std::uint64_t> answered_;
  std::optional<std::uint64_t> force_step_;
  std::optional<std::int64_t> last_round_trip_ns_;
  ServoInput input_;
  Histogram round_trip_;  ///< this and the next: since the last report [ns]
  Histogram age_;
};

}  // namespace irdm
