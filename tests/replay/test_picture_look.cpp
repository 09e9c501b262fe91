#include "common/error.hpp"
#include "replay/pictures/drawn_page.hpp"
#include "tests/support/catch.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::replay;

TEST_CASE("a picture's size and direction are read, or refused with what is meant") {
  PictureLook look;
  read_size("640x480", look);
  CHECK(look.width == 640);
  CHECK(look.height == 480);
  const PictureCamera camera = read_camera("-30,12.5");
  CHECK(camera.azimuth == -30.0);
  CHECK(camera.elevation == 12.5);
  for (const char* bad : {"640", "640x", "x480", "640x480x", "63x480", "640x8193", "a"}) {
    CAPTURE(bad);
    CHECK_THROWS_WITH(read_size(bad, look),
                      ContainsSubstring(bad) && ContainsSubstring("WIDTHxHEIGHT"));
  }
  for (const char* bad : {"30", "30,", "30;10", "nan,0", "0,nan", "0,91", "1e9,0", "0,1,"}) {
    CAPTURE(bad);
    CHECK_THROWS_WITH(read_camera(bad),
                      ContainsSubstring(bad) && ContainsSubstring("AZIMUTH,ELEVATION"));
  }
}
