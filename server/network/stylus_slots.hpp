#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/contact/applied_forces.hpp"
#include "common/realtime/triple_buffer.hpp"
#include "common/stylus.hpp"
#include "common/wire/message.hpp"

namespace irdm {

/// What the force thread knows of one stylus.
struct StylusInput {
  bool present = false;       ///< false: no bridge, or one that has fallen silent; touch nothing
  StylusSample sample = {};   ///< the newest one; meaningless when not present
  bool left = false;          ///< not present because its bridge said goodbye
  bool predicts = false;      ///< its bridge can solve the contact itself
  std::uint64_t session = 0;  ///< changes with the bridge
};

/// What a stylus' bridge says of its link.
struct LinkReport {
  bool reported = false;  ///< else the rest means nothing
  wire::Report report = {};
};

/// Hand-over between network thread and force thread for one stylus: the network thread writes `in`
/// and reads `out`, the force thread the other way round. Neither ever waits.
struct StylusPort {
  TripleBuffer<StylusInput> in;
  TripleBuffer<StylusForce> out;
  // Where the bridge solves the contact:
  TripleBuffer<AppliedHistory> applied;         ///< from the network thread
  TripleBuffer<OfSession<ContactModel>> model;  ///< from the force thread
  TripleBuffer<LinkReport> link;                ///< from the network thread to a viewer's thread
};

/// Which session owns which stylus, and what goes through the ports. Network thread only, except
/// for the other side of port().
class StylusSlots {
 public:
  explicit StylusSlots(int count);

  int count() const noexcept { return static_cast<int>(ports_.size()); }
  StylusPort& port(int slot) { return ports_[static_cast<std::size_t>(slot)]; }

  /// Takes `count` free slots in a row; the first of them, or nothing when there are no such slots.
  /// @param predicts the bridge can solve the contact itself
  std::optional<int> claim(int count, bool predicts = false);
  /// Gives them back; their styluses are absent from here on.
  /// @param in_order their bridge said goodbye
  void release(int first, int count, bool in_order = false);

  /// Hands a sample over; false when it is not newer than the last one of this session.
  bool put(int slot, const StylusSample& sample, std::int64_t now_ns);
  /// The number of the sample after the last one of this session, from 0 on.
  std::uint64_t next_sequence(int slot) const noexcept {
    const Owner& owner = owners_[static_cast<std::size_t>(slot)];
    return owner.any_sample ? owner.newest_sequence + 1 : 0;
  }
  /// Makes those styluses absent whose last sample is older than `limit_ns`.
  void expire(std::int64_t now_ns, std::int64_t limit_ns);

  /// Hands on what the bridge has told of its last steps.
  void put(int slot, const AppliedForces& applied);
  /// The newest contact model that was not taken yet, if the present owner can use it; valid until
  /// the next call.
  const ContactModel* take_model(int slot);

  /// The newest force that was not taken yet, if it answers a sample of the present owner.
  std::optional<StylusForce> take_force(int slot);

 private:
  struct Owner {
    bool claimed = false;
    bool predicts = false;
    std::uint64_t session = 0;
    bool present = false;
    AppliedHistory applied = AppliedHistory();
    bool any_sample = false;
    std::uint64_t newest_sequence = 0;
    std::int64_t first_time_ns = 0;  ///< bridge's clock
    std::int64_t arrived_ns = 0;     ///< our clock
  };
  void make_absent(int slot, bool in_order = false);

  std::vector<StylusPort> ports_;
  std::vector<Owner> owners_;
  std::uint64_t sessions_ = 0;  ///< slots claimed so far
};

}  // namespace irdm
