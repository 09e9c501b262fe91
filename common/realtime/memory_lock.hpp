#pragma once

#include <string>

#include "common/realtime/scheduling.hpp"

namespace irdm {

/// Keeps all memory that this process has now in RAM, so that no real-time thread waits for a page
/// to come in. Called when all that they touch has been made: what comes later is not locked (a
/// limit would then end an allocation), but for the stacks of real-time threads, which see to that
/// themselves (RealTimeScope). Returns what came of it in a few words for a report. Throws Error
/// when it is required and the system does not permit it. Does nothing in a sanitizer's build.
std::string lock_memory(RealTimeScheduling wanted);

}  // namespace irdm
