#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>

#include "tests/viewer/frames.hpp"
#include "viewer/viewer_session.hpp"

namespace irdm::test {

/// Shows the example scene and counts what it is asked for.
struct ExampleRun final : viewer::ViewerSession {
  const viewer::Scene& scene() const override { return scene_; }
  std::vector<viewer::SurfaceSource> sources() override {
    return {{surfaces, ready}, {other_surfaces, other_ready}};
  }
  std::size_t shown_source() const override { return shown; }
  viewer::Health health() override { return {.steps = steps}; }
  viewer::State state() override {
    viewer::State state = example_state();
    state.notice = shown == 0 ? notice : "the other one";
    return state;
  }
  void handle(const viewer::Command& command) override {
    if (command.kind == viewer::CommandKind::kReset) ++resets;
    if (command.kind == viewer::CommandKind::kShowRecording) shown = 1;
  }
  void handle(const viewer::SettingsRequest&) override { ++settings; }
  void handle(const viewer::SceneRequest& request) override {
    if (request.name == "press.toml") ++loads;
  }
  void handle(const viewer::StylusRequest& request) override {
    (request.present ? presses : releases)++;
  }

  viewer::Scene scene_ = example_scene();
  std::string notice = "the first one";
  TripleBuffer<SurfaceFrame> surfaces{example_frame(scene_, 0.001)};
  TripleBuffer<SurfaceFrame> other_surfaces{example_frame(scene_, 0.001, 5)};
  EventFd ready, other_ready;
  std::atomic<std::size_t> shown{0};
  std::atomic<std::uint64_t> steps{77};
  std::atomic<int> resets{0}, settings{0}, presses{0}, releases{0}, loads{0};
};

}  // namespace irdm::test
