#include "replay/output/picture_output.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>

#include "common/error.hpp"
#include "common/process/child_program.hpp"
#include "common/process/temporary_files.hpp"
#include "replay/output/output_file.hpp"
#include "simulation/step/settings.hpp"
#include "viewer/scene_message.hpp"

namespace irdm::replay {
namespace {

constexpr double kLiveRate = 60.0;             // of what a person sees [Hz]
constexpr double kLongestVideo = 24 * 3600.0;  // to make it [s]

void need(const std::string& program, const std::string& why) {
  if (program_exists(program)) return;
  throw Error(program, "is not installed, " + why, "install Debian's package " + program);
}

viewer::ViewerSettings served() {
  viewer::ViewerSettings settings = viewer_settings(ViewerConfig{});
  settings.port = 0;
  if (!settings.page.empty()) return settings;
  throw Error("--frames", "the viewer's page, which draws, is not beside this program",
              "build with -DIRDM_BUILD_PAGE=ON, or install irdm");
}

std::string first_line(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

void make_video(const std::filesystem::path& folder, const std::filesystem::path& video,
                double rate) {
  PartFile file(video);
  char rate_text[32];
  std::snprintf(rate_text, sizeof rate_text, "%.9g", rate);
  const TemporaryFolder folder_of_log("irdm-video");
  const std::filesystem::path log = folder_of_log.path() / "log";
  const ChildEnd end =
      run_child("ffmpeg",
                {"-loglevel", "error", "-framerate", rate_text, "-i", "frame_%05d.png", "-vf",
                 "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-c:v", "libx264", "-pix_fmt", "yuv420p", "-f",
                 "mp4", "-y", std::filesystem::absolute(file.part()).string()},
                folder, log, kLongestVideo);
  if (end != ChildEnd::kSuccess) {
    throw Error(video.string(), "could not be made by ffmpeg: " + first_line(log),
                "make it of the pictures in " + folder.string());
  }
  file.finish();
}

}  // namespace

PictureOutput::PictureOutput(const PicturePlaces& places, const PictureLook& look,
                             const TracedScene& scene, double rate)
    : places_(places),
      rate_(rate),
      surface_(rest_frame(scene.config)),
      run_(viewer_scene(scene.names(), scene.config), initial_settings(scene.config), surface_),
      server_(served(), run_) {
  need("chromium", "which draws the pictures");
  if (places_.video) {
    need("ffmpeg", "which makes the video");
    PartFile(*places_.video);  // so that what is wrong with it is said now
  }
  make_new_folder(places_.folder);
  for (const SimulationObject& object : scene.config.objects) models_.push_back(object.model);
  server_.start();
  page_.emplace(server_.urls().front(), look);
}

void PictureOutput::put(const ReplayFrame& frame) {
  const StepRecord& record = frame.record;
  surface_.force_step = record.force_step;
  surface_.time = record.time;
  for (std::size_t i = 0; i < models_.size(); ++i) {
    surface_.objects[i] = {record.object[i].position, record.object[i].orientation,
                           frame.displacement[i]};
  }
  for (std::size_t s = 0; s < surface_.styluses.size(); ++s) {
    surface_.styluses[s] = record.stylus[s];
    surface_.contacts[s] = {};
    const int touched = record.stylus[s].object;
    if (touched < 0) continue;
    const auto object = static_cast<std::size_t>(touched);
    surface_.contacts[s] = contact_on(models_[object]->mesh, record.object[object].contact[s]);
  }
  surface_.trail.follow(record);
  run_.show(surface_);
  const int live_frames = std::max(1, static_cast<int>(std::lround(kLiveRate / rate_)));
  char name[32];
  std::snprintf(name, sizeof name, "frame_%05d.png", pictures_++);
  const std::filesystem::path path = places_.folder / name;
  std::ofstream file(path, std::ios::binary);
  if (!(file << page_->picture(record.force_step, live_frames)) || !file.flush()) {
    throw Error(path.string(), "cannot be written", "see whether the disk is full");
  }
}

void PictureOutput::finish() {
  page_.reset();
  server_.stop();
  if (places_.video) make_video(places_.folder, *places_.video, rate_);
}

}  // namespace irdm::replay
