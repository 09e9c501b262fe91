// Writes valid messages, where fuzzing begins: write_fuzz_seeds FOLDER. Text seeds are files.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include "common/model/model_writer.hpp"
#include "common/wire/frame.hpp"
#include "server/viewer/message.hpp"
#include "tests/support/synthetic_model.hpp"
#include "tests/viewer/frames.hpp"

using namespace irdm;

namespace {

class Seeds {
 public:
  explicit Seeds(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Of a seed that is to be written; its folder is there.
  std::filesystem::path path(const std::string& harness, const std::string& name) const {
    std::filesystem::create_directories(folder_ / harness);
    return folder_ / harness / name;
  }
  template <typename Bytes>
  void write(const std::string& harness, const std::string& name, const Bytes& bytes) const {
    std::ofstream file(path(harness, name), std::ios::binary);
    for (const auto byte : bytes) file.put(static_cast<char>(byte));
  }

 private:
  std::filesystem::path folder_;
};

void write_client_messages(const Seeds& seeds) {
  const auto hello = encode(viewer::ClientMessage(viewer::Hello{"0123456789abcdef"}));
  const auto put_back = encode(viewer::ClientMessage(viewer::Command{}));
  seeds.write("viewer_client", "hello", hello);
  seeds.write("viewer_client", "no_token", encode(viewer::ClientMessage(viewer::Hello{})));
  seeds.write("viewer_client", "put_back", put_back);
  seeds.write("viewer_client", "seek",
              encode(viewer::ClientMessage(viewer::Command{viewer::CommandKind::kSeek, 0, 1.5})));
  seeds.write("viewer_client", "stylus",
              encode(viewer::ClientMessage(viewer::StylusRequest{true, 1, Vector3(1, 2, 3)})));
  seeds.write(
      "viewer_client", "settings",
      encode(viewer::ClientMessage(viewer::SettingsRequest{test::example_state().settings, 2})));
  // A browser's whole connection, with a mask that changes nothing.
  std::string bytes =
      "GET /live HTTP/1.1\r\nHost: 127.0.0.1:1\r\nOrigin: http://127.0.0.1:1\r\n"
      "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
      "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n";
  for (const viewer::Bytes& message :
       {encode(viewer::ClientMessage(viewer::Hello{})), put_back, put_back}) {
    bytes += {'\x82', static_cast<char>(0x80 | message.size()), 0, 0, 0, 0};
    bytes.append(message.begin(), message.end());
  }
  seeds.write("http_connection", "viewer", bytes);
}

void write_server_messages(const Seeds& seeds) {
  const viewer::Scene scene = test::example_scene();
  seeds.write("viewer_scene", "scene", encode(scene));
  seeds.write("viewer_health", "health", encode(viewer::Health{.links = {{}, {true}}}));
  seeds.write("viewer_state", "state", encode(test::example_state()));
  for (const double size : {0.01, 2.0}) {
    viewer::Bytes message;
    viewer::encode(test::example_frame(scene, size), message);
    viewer::Bytes bytes = {static_cast<std::uint8_t>(scene.objects.size())};
    for (const std::size_t count : test::node_counts(scene)) {
      bytes.push_back(static_cast<std::uint8_t>(count));
    }
    bytes.insert(bytes.end(), message.begin(), message.end());
    seeds.write("viewer_frame", size < 1.0 ? "small" : "large", bytes);
  }
}

/// A fixed wall at y = 0 that gives way by 1 mm per newton within a step.
ContactModel wall() {
  ContactModel model;
  model.valid = true;
  model.step = 100;
  model.newest = 101;
  model.dt = 0.002;
  model.horizon = 25;
  model.body = {1.0, 1e-3 * Matrix3::Identity(), Support::kFixed};
  model.normal = Vector3(0, 1, 0);
  model.friction = {0.6, 0.5};
  for (std::size_t n = 0; n < 25; ++n) {
    model.response[n] = 1e-3 / static_cast<double>(n + 1) * Matrix3::Identity();
  }
  return model;
}

void write_contact_models(const Seeds& seeds) {
  ContactModel model = wall();
  const auto write = [&](const std::string& name) {
    const wire::FrameBytes frame = wire::encode_frame(wire::ContactModelMessage{0, model}, 7, 1, 2);
    seeds.write("contact_model", name, frame.view().subspan(wire::kHeaderSize));
  };
  write("touching_fixed");
  model.body.support = Support::kFloating;
  model.state = ContactState::kHeld;
  model.motion.angular_momentum = Vector3(0, 1e-3, 0);
  model.free_forces.gravity = Vector3(0, -9.81, 0);
  model.missing = 6;
  write("held_floating");
  model.valid = false;
  model.standing = true;
  write("standing");
}

void write_wire_frames(const Seeds& seeds) {
  const wire::Message messages[] = {
      wire::Hello{.name = "bridge"},
      wire::Welcome{.session = 7, .dt = 0.002},
      wire::Refuse{.reason = wire::RefuseReason::kNoFreeStylus, .text = "all in use"},
      wire::Goodbye{},
      wire::SampleMessage{.sample = {.sequence = 3, .tip = Vector3(0.01, 0.02, 0.03)}},
      wire::ForceMessage{.force = {.force_step = 5, .force = Vector3(0.5, 0, -1)}},
      wire::Report{.round_trip = {900.0F, 1500.0F, 3000.0F}},
      wire::ContactModelMessage{0, wall()},
      wire::AppliedForcesMessage{0, {.step = 102, .count = 3, .past = {}}},
      wire::Status{.steps = 9},
  };
  viewer::Bytes stream = {0};
  for (const wire::Message& message : messages) {
    const wire::FrameBytes frame = wire::encode_frame(message, 7, 1, 1000);
    viewer::Bytes single(1 + frame.size, 5);
    std::copy(frame.view().begin(), frame.view().end(), single.begin() + 1);
    stream.insert(stream.end(), frame.view().begin(), frame.view().end());
    seeds.write("wire_frames", "type_" + std::to_string(static_cast<int>(wire::type_of(message))),
                single);
  }
  seeds.write("wire_frames", "all", stream);
}

void write_model_files(const Seeds& seeds) {
  Model model = test::synthetic_cube(1, 2, 3);
  const std::filesystem::path path = seeds.path("model_file", "modal");
  ModelFileWriter writer(path);
  writer.write_description(model);
  writer.write_modal(std::get<ModalResponse>(model.response));
  writer.commit();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const Seeds seeds(argv[1]);
  write_client_messages(seeds);
  write_server_messages(seeds);
  write_wire_frames(seeds);
  write_contact_models(seeds);
  write_model_files(seeds);
  return 0;
}
