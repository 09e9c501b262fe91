#include "replay/pictures/drawn_page.hpp"

#include <array>
#include <charconv>
#include <cstdio>

#include "common/error.hpp"

namespace irdm::replay {

DrawnRun::DrawnRun(viewer::Scene scene, const Settings& settings, const SurfaceFrame& first)
    : scene_(std::move(scene)), surfaces_(first) {
  scene_.recorded = true;
  state_.playback = true;
  state_.settings = settings;
  state_.choices.resize(scene_.objects.size());  // nothing can be chosen
}

void DrawnRun::show(const SurfaceFrame& frame) {
  surfaces_.put(frame);
  ready_.signal();
}

namespace {

// Two numbers with a letter between them, and nothing else.
template <typename Number>
std::optional<std::array<Number, 2>> two_numbers(const std::string& text, char between) {
  std::array<Number, 2> numbers{};
  const char* const end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, numbers[0]);
  if (first.ec != std::errc{} || first.ptr == end || *first.ptr != between) return std::nullopt;
  const auto second = std::from_chars(first.ptr + 1, end, numbers[1]);
  if (second.ec != std::errc{} || second.ptr != end) return std::nullopt;
  return numbers;
}

}  // namespace

void read_size(const std::string& text, PictureLook& look) {
  const auto size = two_numbers<int>(text, 'x');
  const auto fits = [](int length) { return length >= 64 && length <= 8192; };
  if (!size || !fits(size->front()) || !fits(size->back())) {
    throw Error("--size " + shortened(text), "is no size of a picture",
                "give WIDTHxHEIGHT, each from 64 to 8192 pixels");
  }
  look.width = size->front();
  look.height = size->back();
}

PictureCamera read_camera(const std::string& text) {
  const auto angles = two_numbers<double>(text, ',');
  if (!angles || !(angles->front() >= -360.0 && angles->front() <= 360.0) ||
      !(angles->back() >= -90.0 && angles->back() <= 90.0)) {
    throw Error("--camera " + shortened(text), "is no direction",
                "give AZIMUTH,ELEVATION in degrees, the second from -90 to 90");
  }
  return {angles->front(), angles->back()};
}

namespace {

// What the page is asked in: `until` waits for something, `painted` for what is on the screen,
// which is one frame after it was drawn.
constexpr const char* kPageWords = R"(
  window.until = (holds) => new Promise((resolve, reject) => {
    const end = performance.now() + 50000;
    const look = () => holds() ? resolve() :
      performance.now() > end ? reject(new Error("what is to be drawn does not come")) : setTimeout(look, 2);
    look();
  });
  window.painted = () => new Promise((resolve) => requestAnimationFrame(() => {
    irdm.world.drawNow();
    requestAnimationFrame(() => requestAnimationFrame(resolve));
  }));
)";

// The scene alone. A sheet that is made by a script is permitted by the page's own rules.
constexpr const char* kSceneAlone = R"(
  const sheet = new CSSStyleSheet();
  sheet.replaceSync("body { display: block !important } .panel { display: none !important } " +
    ".stage { position: fixed !important; inset: 0; height: auto !important } " +
    ".bar, .status, #playback, #notices, #tools, #hint { display: none !important }");
  document.adoptedStyleSheets = [sheet];
)";

std::string in_script(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

std::string promise(const std::string& statements) {
  return "(async () => {" + statements + "})()";
}

std::string controls(const PictureLook& look) {
  const auto flag = [](bool value) { return value ? "true" : "false"; };
  return "const control = (name, key, value) => { const input = document.getElementById(name); "
         "input[key] = value; input.dispatchEvent(new Event('input')); };"
         "control('exaggeration', 'value', " +
         in_script(look.exaggeration) + "); control('rigid', 'checked', " + flag(look.rigid) +
         "); control('follow', 'checked', " + flag(!look.still) +
         "); control('colour', 'value', '" + look.colour + "');";
}

// In the picture as a whole, and then turned.
std::string camera(const PictureLook& look) {
  if (!look.camera) return "irdm.world.fit();";
  return "irdm.world.fit(); { const turn = Math.PI / 180; "
         "const { x, y, z } = irdm.world.camera.position.clone().sub(irdm.world.controls.target); "
         "irdm.world.move(" +
         in_script(look.camera->azimuth) + " * turn - Math.atan2(x, z), Math.PI / 2 - " +
         in_script(look.camera->elevation) + " * turn - Math.acos(y / Math.hypot(x, y, z)), 1); }";
}

}  // namespace

DrawnPage::DrawnPage(const std::string& url, const PictureLook& look)
    : browser_({look.width, look.height, look.dark}), look_(look) {
  browser_.open(url);
  browser_.evaluate(promise(std::string(kPageWords) + "await until(() => window.irdm?.state());"));
  if (browser_.evaluate("irdm.world === null") == "true") {
    throw Error("chromium", "has no WebGL, with which the page draws",
                "install a Chromium that can draw without a GPU, as Debian's can");
  }
  browser_.evaluate(promise(kSceneAlone + controls(look)));
}

std::string DrawnPage::picture(std::uint64_t force_step, int frames) {
  browser_.evaluate(
      promise("await until(() => irdm.frame()?.step === " + std::to_string(force_step) + ");" +
              (first_ ? camera(look_)
                      : "for (let k = 1; k < " + std::to_string(frames) +
                            "; ++k) irdm.world.follow(irdm.frame());") +
              "await painted();"));
  first_ = false;
  return browser_.picture();
}

}  // namespace irdm::replay
