#include "replay/pictures/drawn_run.hpp"

namespace irdm::replay {

DrawnRun::DrawnRun(viewer::Scene scene, const Settings& settings, const SurfaceFrame& first)
    : scene_(std::move(scene)), surfaces_(first) {
  scene_.recorded = true;
  state_.playback = true;
  state_.settings = settings;
  state_.choices.resize(scene_.objects.size());  // nothing can be chosen
}

void DrawnRun::show(const SurfaceFrame& frame) {
  surfaces_.put(frame);
  ready_.signal();
}

}  // namespace irdm::replay
