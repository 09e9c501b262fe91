#pragma once

#include "scene/columns/scene_columns.hpp"
#include "server/run_server.hpp"
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
  const RealTimeClock* clock;      ///< null: lockstep
  std::string memory;              ///< whether it is locked, in words
  const SceneColumns& columns;
  std::uint64_t viewers_unlogged;  ///< complaints about viewers beyond what is logged
};

/// Prints how the run went and returns the exit status: 1 when the recording is not whole.
int print_report(const FinishedRun& run, const ServerOptions& options);

}  // namespace irdm
