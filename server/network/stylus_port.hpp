#pragma once

#include "common/realtime/triple_buffer.hpp"
#include "common/stylus.hpp"
#include "common/wire/message.hpp"
#include "simulation/step/applied_history.hpp"

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

/// A contact model for the bridge of a session.
struct ServedModel {
  std::uint64_t session = 0;
  ContactModel model;
};

/// Hand-over between network thread and force thread for one stylus: the network thread writes `in`
/// and reads `out`, the force thread the other way round. Neither ever waits.
struct StylusPort {
  TripleBuffer<StylusInput> in;
  TripleBuffer<StylusForce> out;
  // Where the bridge solves the contact:
  TripleBuffer<AppliedHistory> applied;  ///< from the network thread
  TripleBuffer<ServedModel> model;       ///< from the force thread
  TripleBuffer<LinkReport> link;         ///< from the network thread to a viewer's thread
};

}  // namespace irdm
