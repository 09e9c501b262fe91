// Writes messages as the server encodes them, and what is in them, for the page's own test of its
// decoder: write_viewer_samples FOLDER
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <sstream>

#include "tests/viewer/frames.hpp"

using namespace irdm;
using namespace irdm::test;

namespace {

void write(const std::filesystem::path& path, const viewer::Bytes& bytes) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}

template <typename Values>
std::string list(const Values& values) {
  std::ostringstream text;
  text << std::setprecision(17) << '[';
  for (Eigen::Index i = 0; i < values.size(); ++i) text << (i > 0 ? "," : "") << values.data()[i];
  text << ']';
  return text.str();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const std::filesystem::path folder = argv[1];
  std::filesystem::create_directories(folder);
  const viewer::Scene scene = example_scene();
  const SurfaceFrame small = example_frame(scene, 0.01);
  const SurfaceFrame large = example_frame(scene, 2.0, 2);
  write(folder / "scene.bin", encode(scene));
  viewer::Bytes bytes;
  viewer::encode(small, bytes);
  write(folder / "small.bin", bytes);
  viewer::encode(large, bytes);
  write(folder / "large.bin", bytes);
  viewer::Health health;
  health.steps = 1234567890123;
  health.step_time = {1.5F, 2.5F, 3.5F};
  health.protocol_errors = 9;
  write(folder / "health.bin", encode(health));
  write(folder / "hello.bin", encode(viewer::ClientMessage(viewer::Hello{"token \xC3\xBC"})));
  write(folder / "state.bin", encode(example_state()));
  const auto ask = [&](const std::string& name, const viewer::ClientMessage& message) {
    write(folder / (name + ".bin"), encode(message));
  };
  ask("look_on", viewer::Hello{"", true});
  ask("reset", viewer::Command{});
  ask("seek", viewer::Command{viewer::CommandKind::kSeek, 0, 1.25});
  ask("show_recording", viewer::Command{viewer::CommandKind::kShowRecording, 3, 0.0});
  ask("save_scene", viewer::Command{viewer::CommandKind::kSaveScene, 0, 0.0});
  ask("load_scene", viewer::SceneRequest{"w\xC3\xBCrfel.h5"});
  ask("stylus", viewer::StylusRequest{true, kGrabButton, Vector3(0.1, -0.2, 0.3)});
  ask("settings", viewer::SettingsRequest{example_state().settings, 2});
  std::ofstream json(folder / "expected.json");
  json << "{\"rest\":" << list(scene.objects[0].rest)
       << ",\"triangles\":" << list(scene.objects[1].triangles)
       << ",\"small\":" << list(small.objects[0].displacement)
       << ",\"large\":" << list(large.objects[1].displacement)
       << ",\"position\":" << list(small.objects[1].position)
       << ",\"tip\":" << list(small.styluses[1].tip)
       << ",\"capsule\":" << list(scene.scenery[3].position)
       << ",\"contactNormal\":" << list(small.body_contacts[1].normal)
       << ",\"contactPosition\":" << list(small.body_contacts[1].position)
       << ",\"contactForce\":" << list(small.body_contacts[1].force)
       << ",\"oldestForce\":" << list(small.trail.force(127, 0))
       << ",\"newestForce\":" << list(small.trail.force(0, 1)) << "}\n";
  return json ? 0 : 1;
}
