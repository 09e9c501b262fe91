#pragma once

#include "server/config/scene.hpp"
#include "server/network/network_server.hpp"
#include "server/threads/deformation_thread.hpp"
#include "server/threads/force_thread.hpp"
#include "server/viewer/viewer_server.hpp"

namespace irdm {

/// What the viewers of a run see, and that they may put everything back. The threads must outlive
/// the feed.
viewer::ViewerFeed viewer_feed(const SceneConfig& scene, const SimulationConfig& config,
                               bool lockstep, DeformationThread& deformation, ForceThread& force,
                               const NetworkServer& network);

/// Where and for whom the viewer listens, with the page that was built with this program.
viewer::ViewerSettings viewer_settings(const ViewerConfig& config);

}  // namespace irdm
