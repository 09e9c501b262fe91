#pragma once

#include "common/stylus.hpp"

namespace irdm {

/// What the servo loop knows of the server's forces for one stylus.
struct ServoInput {
  bool linked = false;     ///< a session is on
  bool any_force = false;  ///< `force` is of this session (or of the last one, when not linked)
  StylusForce force = {};  ///< the newest
};

}  // namespace irdm
