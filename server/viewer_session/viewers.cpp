#include "server/viewer_session/viewers.hpp"

#include "viewer/scene_message.hpp"

namespace irdm {

Viewers::Viewers(const PreparedRun& run, int deformation_threads, const std::string& refusal,
                 const Parts& parts)
    : player_(run.config, names_of(run.scene), run.scene.server.deformation_rate,
              deformation_threads),
      scenes_(parts.loader, run, refusal),
      run_(*run.seen, run.config,
           {parts.deformation, parts.force, parts.control, parts.network, parts.recordings, player_,
            scenes_, parts.run_recorder},
           run.greeting),
      server_(viewer_settings(run.scene.viewer), run_) {}

void Viewers::start() {
  player_.start();
  server_.start();
}

void Viewers::stop() {
  server_.stop();
  player_.finish();
}

}  // namespace irdm
