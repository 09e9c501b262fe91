#pragma once

#include <filesystem>
#include <string>

#include "server/viewer_session/player.hpp"
#include "viewer/message.hpp"
#include "viewer/viewer_session.hpp"

namespace irdm {

/// What viewers see and ask of a player. Viewer's thread.
class Playback {
 public:
  explicit Playback(Player& player) : player_(player) {}

  /// Whether a recording is shown, or about to be.
  bool on() const noexcept { return on_; }
  void show(const std::filesystem::path& path, std::uint16_t number);
  void leave();
  /// True when it is a command for a recorded run; it is then carried out.
  bool handle(const viewer::Command& command);

  /// Fills in what a State says of the recorded run. A recording that cannot be shown ends it, and
  /// `notice` says why.
  void report(viewer::State& state, std::string& notice);

 private:
  Player& player_;
  bool on_ = false;
  std::uint16_t number_ = viewer::State::kNone;
  std::uint64_t loads_ = 0;
};

/// A recorded run and nothing else, as viewers see it. Viewer's thread.
class RecordedRun final : public viewer::ViewerSession {
 public:
  /// Begins to play it. @param player must outlive this object
  RecordedRun(viewer::Scene scene, const SimulationConfig& config, Player& player,
              const std::filesystem::path& trace);

  const viewer::Scene& scene() const override { return scene_; }
  std::vector<viewer::SurfaceSource> sources() override {
    return {{player_.surfaces(), player_.surface_ready()}};
  }
  std::size_t shown_source() const override { return 0; }
  viewer::Health health() override { return {}; }
  viewer::State state() override;
  void handle(const viewer::Command& command) override { playback_.handle(command); }
  void handle(const viewer::SettingsRequest&) override {}
  void handle(const viewer::StylusRequest&) override {}
  void handle(const viewer::SceneRequest&) override {}

 private:
  viewer::Scene scene_;
  Player& player_;
  Playback playback_;
  Settings settings_;
  std::size_t objects_;
  std::string notice_;
};

}  // namespace irdm
