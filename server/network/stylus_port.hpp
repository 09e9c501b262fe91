#pragma once

#include "common/realtime/mailbox.hpp"
#include "common/stylus.hpp"
#include "common/wire/message.hpp"

namespace irdm {

/// What the force thread knows of one stylus.
struct StylusInput {
  bool present = false;      ///< false: no bridge, or one that has fallen silent; touch nothing
  StylusSample sample = {};  ///< the newest one; meaningless when not present
};

/// What a stylus' bridge says of its link.
struct LinkReport {
  bool reported = false;  ///< else the rest means nothing
  wire::Report report = {};
};

/// Hand-over between network thread and force thread for one stylus: the network thread writes `in`
/// and reads `out`, the force thread the other way round. Neither ever waits.
struct StylusPort {
  Mailbox<StylusInput> in;
  Mailbox<StylusForce> out;
  Mailbox<LinkReport> link;  ///< from the network thread to a viewer's thread
};

}  // namespace irdm
