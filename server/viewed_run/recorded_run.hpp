#pragma once

#include <filesystem>

#include "server/viewed_run/playback.hpp"
#include "viewer/viewed_run.hpp"

namespace irdm {

/// A recorded run and nothing else, as viewers see it. Viewer's thread.
class RecordedRun final : public viewer::ViewedRun {
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
  void carry_out(const viewer::Command& command) override { playback_.carry_out(command); }
  void carry_out(const viewer::SettingsRequest&) override {}
  void carry_out(const viewer::StylusRequest&) override {}

 private:
  viewer::Scene scene_;
  Player& player_;
  Playback playback_;
  Settings settings_;
  std::size_t objects_;
  std::string notice_;
};

}  // namespace irdm
