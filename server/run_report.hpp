#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scene/columns/column_store.hpp"
#include "server/network/network_server.hpp"
#include "server/threads/deformation_thread.hpp"
#include "server/threads/force_thread.hpp"
#include "server/threads/recorder_thread.hpp"
#include "server/threads/step_clock.hpp"

namespace irdm {

/// The threads of a run that has ended.
struct FinishedRun {
  const ForceThread& force;
  const NetworkServer& network;
  const DeformationThread& deformation;
  const RecorderThread* recorder;  ///< null: not recorded
  std::string trace;               ///< file of the recording
  const RealTimeClock* clock;      ///< null: lockstep
  std::string memory;              ///< whether it is locked, in words
  const SceneColumns& columns;
  std::uint64_t viewers_unlogged;  ///< complaints about viewers beyond what is logged
};

/// Prints `listening on WHERE` for each place.
void say_where(const std::vector<std::string>& places);

/// Prints how the run went and returns the exit status: 1 when the recording is not whole.
int print_report(const FinishedRun& run);

}  // namespace irdm
