#pragma once

#include "viewer/viewed_run.hpp"

namespace irdm::replay {

/// A run of which one surface after the other is put before the viewer, which can ask for nothing.
class DrawnRun final : public viewer::ViewedRun {
 public:
  /// @param first a frame of the scene's objects and styluses
  DrawnRun(viewer::Scene scene, const Settings& settings, const SurfaceFrame& first);

  /// Any one thread.
  void show(const SurfaceFrame& frame);

  const viewer::Scene& scene() const override { return scene_; }
  std::vector<viewer::SurfaceSource> sources() override { return {{surfaces_, ready_}}; }
  std::size_t shown_source() const override { return 0; }
  viewer::Health health() override { return {}; }
  viewer::State state() override { return state_; }
  void carry_out(const viewer::Command&) override {}
  void carry_out(const viewer::SettingsRequest&) override {}
  void carry_out(const viewer::StylusRequest&) override {}

 private:
  viewer::Scene scene_;
  viewer::State state_;
  TripleBuffer<SurfaceFrame> surfaces_;
  EventFd ready_;
};

}  // namespace irdm::replay
