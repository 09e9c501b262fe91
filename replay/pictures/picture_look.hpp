#pragma once

#include <optional>
#include <string>

namespace irdm::replay {

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

}  // namespace irdm::replay
