#pragma once

#include <cstdint>

#include "replay/pictures/browser.hpp"
#include "replay/pictures/picture_look.hpp"

namespace irdm::replay {

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
