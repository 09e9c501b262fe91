#pragma once

#include "server/prepared_run.hpp"
#include "server/viewer_session/live_run.hpp"
#include "viewer/viewer_server.hpp"

namespace irdm {

/// The viewers of a live run, and what they need besides its threads.
class Viewers {
 public:
  /// The threads of the run; they must outlive this object.
  struct Parts {
    DeformationThread& deformation;
    ForceThread& force;
    RunControl& control;
    NetworkServer& network;
    Recordings& recordings;
    SceneLoader& loader;
    const RecorderThread* run_recorder;  ///< of the whole run; nullptr: there is none
  };
  /// Listens. Throws Error. @param deformation_threads OpenMP threads for surfaces of recorded runs
  /// @param run must outlive this object
  /// @param refusal as of SceneChoice
  Viewers(const PreparedRun& run, int deformation_threads, const std::string& refusal,
          const Parts& parts);

  void start();
  void stop();
  std::vector<std::string> urls() const { return server_.urls(); }
  std::uint16_t port() const noexcept { return server_.port(); }
  std::uint64_t unlogged() const noexcept { return server_.unlogged(); }

 private:
  Player player_;
  SceneChoice scenes_;
  LiveRun run_;
  viewer::ViewerServer server_;
};

}  // namespace irdm
