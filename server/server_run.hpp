#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "server/blackbox/server_black_box.hpp"
#include "server/network/network_server.hpp"
#include "server/prepared_run.hpp"
#include "server/threads/deformation_thread.hpp"
#include "server/threads/force_thread.hpp"
#include "server/threads/recorder_thread.hpp"
#include "server/threads/status_thread.hpp"
#include "server/viewer_session/recordings.hpp"
#include "server/viewer_session/viewers.hpp"

namespace irdm {

/// The threads of one live run, from listening to the report. Made, started and finished by the
/// main thread.
/// Large: it owns every part of a run, in the order in which they depend on each other.
class ServerRun {
 public:
  /// What is asked of a run beside its scene.
  struct Options {
    std::optional<std::filesystem::path> record = {};  ///< trace file
    std::uint64_t steps = 0;                           ///< to make; 0: until it is finished
    bool any_datagram_port = false;                    ///< UDP may have another number than TCP
  };
  /// Binds and listens. Throws Error. @param run, loader must outlive this object
  ServerRun(PreparedRun& run, SceneLoader& loader, const Options& options);

  /// Throws Error.
  void start();
  /// Readable when the run has made its last step.
  int ended_descriptor() noexcept { return force_.finished().descriptor(); }
  /// Ends every thread in order: bridges get no force any more, files are whole.
  void finish();
  /// After finish(). Prints how the run went and returns the exit status.
  int report() const;

  std::uint64_t steps() const noexcept { return force_.report().steps; }  ///< after finish()
  std::uint16_t port() const noexcept { return network_.port_number(); }
  std::uint16_t viewer_port() const noexcept { return viewers_ ? viewers_->port() : 0; }

 private:
  std::unique_ptr<RecorderThread> make_recorder();
  std::vector<StepSink*> sinks();
  std::unique_ptr<StepClock> make_clock();
  std::unique_ptr<Viewers> make_viewers();
  std::string no_other_scene() const;
  void end_recording();
  bool real_time() const { return scheduling_ != RealTimeScheduling::kIgnore; }

  PreparedRun& run_;
  SceneLoader& loader_;
  Options options_;
  RealTimeScheduling scheduling_;
  ServerBlackBox black_box_;
  NetworkServer network_;
  RunControl control_;
  DeformationThread deformation_;
  StepSink recorder_sink_;
  std::unique_ptr<RecorderThread> recorder_;  ///< null: not recorded
  Recordings recordings_;
  std::unique_ptr<StepClock> clock_;
  ForceThread force_;
  std::unique_ptr<Viewers> viewers_;  ///< null: there are none
  StatusThread status_;
  std::string memory_;  ///< whether it is locked, in words
};

}  // namespace irdm
