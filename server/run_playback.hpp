#pragma once

#include "server/run_server.hpp"

namespace irdm {

/// Shows the recorded run `options.play` to browsers until a signal asks it to stop. Returns the
/// exit status. Throws Error.
int run_playback(const ServerOptions& options);

}  // namespace irdm
