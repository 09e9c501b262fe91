#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "replay/pictures/browser.hpp"
#include "viewer/viewer_session.hpp"

namespace irdm::replay {

/// A run of which one surface after the other is put before the viewer, which can ask for nothing.
class DrawnRun final : public viewer::ViewerSession {
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
  void handle(const viewer::Command&) override {}
  void handle(const viewer::SettingsRequest&) override {}
  void handle(const viewer::StylusRequest&) override {}
  void handle(const viewer::SceneRequest&) override {}

 private:
  viewer::Scene scene_;
  viewer::State state_;
  TripleBuffer<SurfaceFrame> surfaces_;
  EventFd ready_;
};

/// Where a picture is seen from, round about the objects.
struct PictureCamera {
  double azimuth = 0.0;    ///< round the vertical, from the z axis towards x [degrees]
  double elevation = 0.0;  ///< above the horizon [degrees]
};

/// How a run is drawn: what a person would set by the page's controls.
struct PictureLook {
  int width = 1280;  ///< [px]
  int height = 720;
  std::optional<PictureCamera> camera = {};  ///< none: the page's own
  bool still = false;                        ///< it does not go along with the objects
  double exaggeration = 1.0;                 ///< of the deformation, 0 to 20
  bool rigid = false;                        ///< the rigid body as a wireframe
  std::string colour = "none";               ///< or "displacement", "velocity", "compliance"
  bool dark = false;
};

/// "WIDTHxHEIGHT" into a look. Throws Error.
void read_size(const std::string& text, PictureLook& look);

/// "AZIMUTH,ELEVATION" [degrees]. Throws Error.
PictureCamera read_camera(const std::string& text);

/// The viewer's page without its controls, in a browser without a screen.
class DrawnPage {
 public:
  /// Throws Error, also when this browser cannot draw.
  DrawnPage(const std::string& url, const PictureLook& look);

  /// A PNG file's bytes, once the page shows this step. The camera goes along as it does in a live
  /// view that shows so many frames since the last picture.
  std::string picture(std::uint64_t force_step, int frames);

 private:
  Browser browser_;
  PictureLook look_;
  bool first_ = true;
};

}  // namespace irdm::replay
