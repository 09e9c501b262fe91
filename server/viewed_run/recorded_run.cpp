#include "server/viewed_run/recorded_run.hpp"

namespace irdm {

RecordedRun::RecordedRun(viewer::Scene scene, const SimulationConfig& config, Player& player,
                         const std::filesystem::path& trace)
    : scene_(std::move(scene)),
      player_(player),
      playback_(player),
      settings_(initial_settings(config)),
      objects_(config.objects.size()) {
  scene_.recorded = true;
  scene_.viewer_stylus = false;
  playback_.show(trace, viewer::State::kNone);
}

viewer::State RecordedRun::state() {
  viewer::State state;
  playback_.report(state, notice_);
  state.notice = notice_;
  state.settings = settings_;
  state.choices.resize(objects_);  // nothing can be chosen
  return state;
}

}  // namespace irdm
