#pragma once

#include <string>

#include "scene/scene.hpp"
#include "server/network/network_server.hpp"
#include "server/threads/deformation_thread.hpp"
#include "server/threads/force_thread.hpp"
#include "server/threads/recorder_thread.hpp"
#include "server/viewer_session/playback.hpp"
#include "server/viewer_session/recordings.hpp"
#include "server/viewer_session/scene_choice.hpp"
#include "viewer/viewer_session.hpp"

namespace irdm {

/// A live run as viewers see it, and what they ask of it. Viewer's thread.
class LiveRun final : public viewer::ViewerSession {
 public:
  /// The threads of the run and what goes with them; they must outlive this object.
  struct Parts {
    DeformationThread& deformation;
    ForceThread& force;
    RunControl& control;
    NetworkServer& network;
    Recordings& recordings;
    Player& player;
    SceneChoice& scenes;
    const RecorderThread* run_recorder = nullptr;  ///< of the whole run; nullptr: there is none
  };
  /// @param notice that viewers are shown at first; empty: none
  LiveRun(viewer::Scene scene, SimulationConfig config, const Parts& parts, std::string notice);

  const viewer::Scene& scene() const override { return scene_; }
  std::vector<viewer::SurfaceSource> sources() override;
  std::size_t shown_source() const override { return playback_.on() ? 1 : 0; }
  viewer::Health health() override;
  viewer::State state() override;
  void handle(const viewer::Command& command) override;
  void handle(const viewer::SettingsRequest& request) override;
  void handle(const viewer::StylusRequest& request) override;
  void handle(const viewer::SceneRequest& request) override;

 private:
  void handle_live(const viewer::Command& command);
  void begin_recording();
  void save_scene();
  void show_recording(std::size_t number);
  void show_live();
  /// Shows viewers at once that a recording has ended early, and ends it.
  void notice_failed_recordings();
  viewer::LinkHealth link_health(int stylus);
  float surface_rate();

  viewer::Scene scene_;
  SimulationConfig config_;
  Parts parts_;
  Playback playback_;
  bool paused_before_playback_ = false;
  bool failure_noticed_ = false;  ///< of the recording of the whole run
  Settings settings_;
  std::uint32_t settings_changes_ = 0;
  std::uint64_t stylus_sequence_ = 0;
  std::string notice_;
  std::uint64_t withheld_ = 0;  ///< that the page was told last

  std::int64_t since_ns_;  ///< and the next two: of the surface rate
  std::uint64_t frames_ = 0;
  float rate_ = 0;
};

}  // namespace irdm
