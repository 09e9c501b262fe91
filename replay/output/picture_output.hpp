#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "replay/output/run_output.hpp"
#include "replay/pictures/drawn_page.hpp"
#include "replay/traced_scene.hpp"
#include "viewer/viewer_server.hpp"

namespace irdm::replay {

/// Where pictures go.
struct PicturePlaces {
  std::filesystem::path folder;                ///< new or empty
  std::optional<std::filesystem::path> video;  ///< of them; must not exist
};

/// Pictures with the look of the live viewer, FOLDER/frame_00000.png and so on: its page in a
/// browser without a screen, which is served the frames one by one. With ffmpeg a video of them.
class PictureOutput final : public FrameOutput {
 public:
  /// @param rate frames a second of the run [Hz]
  /// Throws Error, also where what is needed is not installed.
  PictureOutput(const PicturePlaces& places, const PictureLook& look, const TracedScene& scene,
                double rate);

  bool needs_surfaces() const override { return true; }
  void put(const ReplayFrame& frame) override;
  void finish() override;

 private:
  PicturePlaces places_;
  std::vector<std::shared_ptr<const Model>> models_;
  double rate_;
  SurfaceFrame surface_;
  DrawnRun run_;
  viewer::ViewerServer server_;
  std::optional<DrawnPage> page_;
  int pictures_ = 0;
};

}  // namespace irdm::replay
