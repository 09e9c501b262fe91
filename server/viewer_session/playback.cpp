#include "server/viewer_session/playback.hpp"

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

using viewer::CommandKind;

void Playback::show(const std::filesystem::path& path, std::uint16_t number) {
  on_ = true;
  number_ = number;
  ++loads_;
  player_.load(path);
}

void Playback::leave() {
  on_ = false;
  number_ = viewer::State::kNone;
  player_.pause();
}

bool Playback::handle(const viewer::Command& command) {
  if (!on_) return false;
  switch (command.kind) {
    case CommandKind::kReset:
      player_.seek(0.0);
      return true;
    case CommandKind::kPlay:
      player_.play();
      return true;
    case CommandKind::kPausePlayback:
      player_.pause();
      return true;
    case CommandKind::kSeek:
      player_.seek(command.value);
      return true;
    case CommandKind::kSetSpeed:
      player_.set_speed(command.value);
      return true;
    default:
      return false;
  }
}

void Playback::report(viewer::State& state, std::string& notice) {
  player_.status().receive();
  const PlayerStatus& status = player_.status().front();
  if (on_ && status.loads == loads_ && !status.error.empty()) {
    notice = status.error;
    leave();
  }
  state.playback = on_;
  state.shown = number_;
  state.speed = status.speed;
  if (!on_ || status.loads != loads_) return;
  state.playing = status.playing;
  state.length = status.length;
}

}  // namespace irdm
