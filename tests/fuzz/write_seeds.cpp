// Writes valid messages, where fuzzing begins: write_fuzz_seeds FOLDER. Text seeds are files.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <vector>

#include "common/wire/frame.hpp"
#include "common/wire/frame_parts.hpp"
#include "server/viewer/message.hpp"
#include "tests/fuzz/mended_frames.hpp"
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
  /// A message between server and viewer; `kind` as viewer_message() counts them.
  void write_viewer(std::uint8_t kind, const std::string& name, viewer::Bytes bytes) const {
    bytes.insert(bytes.begin(), kind);
    write("viewer_message", name, bytes);
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
  seeds.write_viewer(0, "hello", hello);
  seeds.write_viewer(0, "no_token", encode(viewer::ClientMessage(viewer::Hello{})));
  seeds.write_viewer(0, "put_back", put_back);
  seeds.write_viewer(
      0, "seek",
      encode(viewer::ClientMessage(viewer::Command{viewer::CommandKind::kSeek, 0, 1.5})));
  seeds.write_viewer(
      0, "stylus", encode(viewer::ClientMessage(viewer::StylusRequest{true, 1, Vector3(1, 2, 3)})));
  seeds.write_viewer(
      0, "settings",
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
  seeds.write_viewer(1, "scene", encode(scene));
  seeds.write_viewer(2, "health", encode(viewer::Health{.links = {{}, {true}}}));
  seeds.write_viewer(3, "state", encode(test::example_state()));
  for (const double size : {0.01, 2.0}) {
    viewer::Bytes message;
    viewer::encode(test::example_frame(scene, size), message);
    viewer::Bytes bytes = {static_cast<std::uint8_t>(scene.objects.size())};
    for (const std::size_t count : test::node_counts(scene)) {
      bytes.push_back(static_cast<std::uint8_t>(count));
    }
    bytes.insert(bytes.end(), message.begin(), message.end());
    seeds.write_viewer(4, size < 1.0 ? "small" : "large", bytes);
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

using Change = void (*)(ContactModel&);

/// Models that cannot be true, one for each reason.
std::vector<ContactModel> untrue() {
  const Change changes[] = {
      [](ContactModel& it) { it.body.mass = 1e-9; },
      [](ContactModel& it) { it.body.inertia(0, 0) = -1.0; },
      [](ContactModel& it) { it.motion.position.x() = 1e6; },
      [](ContactModel& it) { it.normal *= 2.0; },
      [](ContactModel& it) { it.friction.kinetic = 7.0; },
      [](ContactModel& it) { it.response[0] *= -1.0; },
      [](ContactModel& it) { it.response[0] *= 1e9; },
      [](ContactModel& it) { it.response[3] *= 1e3; },
      [](ContactModel& it) { it.path[2].x() = 1e6; },
  };
  std::vector<ContactModel> models;
  for (const Change change : changes) change(models.emplace_back(wall()));
  return models;
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
  int number = 0;
  for (const ContactModel& each : untrue()) {
    model = each;
    write("untrue_" + std::to_string(number++));
  }
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
      wire::Datagrams{.port = 4000},
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

/// A record of the harness `datagrams`.
void add_record(viewer::Bytes& records, std::uint8_t kind, std::size_t number,
                std::span<const std::uint8_t> bytes = {}) {
  records.push_back(kind);
  records.push_back(static_cast<std::uint8_t>(number % 256));
  records.push_back(static_cast<std::uint8_t>(number / 256));
  records.insert(records.end(), bytes.begin(), bytes.end());
}

void write_datagrams(const Seeds& seeds) {
  constexpr std::uint8_t kForeign = 0, kSealed = 1, kFrame = 2, kAgain = 3, kSpoilt = 4, kLost = 5;
  viewer::Bytes all;
  for (const wire::Message& message :
       {wire::Message(wire::SampleMessage{.sample = {.sequence = 3}}),
        wire::Message(wire::ContactModelMessage{0, wall()}),
        wire::Message(wire::AppliedForcesMessage{0, {.step = 102, .count = 3, .past = {}}}),
        wire::Message(wire::ForceMessage{.force = {.force_step = 5}}),
        wire::Message(wire::Report{})}) {
    const wire::FrameBytes frame = wire::encode_frame(message, fuzz::kFuzzedSession, 1, 1000);
    add_record(all, kFrame, frame.size, frame.view());
    add_record(all, kLost, 3);
  }
  const wire::PartText probe = wire::probe_text();
  add_record(all, kSealed, probe.size, probe.view());
  add_record(all, kAgain, 0);
  add_record(all, kSpoilt, 100);
  viewer::Bytes forged(28);
  forged[0] = fuzz::kFuzzedSession;
  add_record(all, kForeign, forged.size(), forged);
  add_record(all, kForeign, 5, viewer::Bytes(5, 1));
  seeds.write("datagrams", "all", all);
  const auto text = [&](const std::string& name, std::vector<viewer::Bytes> texts) {
    viewer::Bytes records;
    for (const viewer::Bytes& each : texts) add_record(records, kSealed, each.size(), each);
    seeds.write("datagrams", name, records);
  };
  const auto part = [](std::uint8_t number, std::uint8_t of, std::size_t size) {
    viewer::Bytes bytes(wire::kPartHeaderSize + size, 0x49);
    bytes[0] = number;
    bytes[1] = of;
    return bytes;
  };
  text("empty", {{}});
  text("cut", {part(0, 3, 100)});
  text("beyond", {part(3, 3, 100)});
  text("misfits", {part(0, 3, wire::kLargestPart), part(1, 4, wire::kLargestPart)});
  text("no_frame", {part(0, 1, 100)});
  text("many", std::vector<viewer::Bytes>(20, part(0, 2, wire::kLargestPart)));
  const wire::FrameBytes goodbye = wire::encode_frame(wire::Goodbye{}, fuzz::kFuzzedSession, 1, 0);
  viewer::Bytes more = part(0, 1, goodbye.size + 1);
  std::copy(goodbye.view().begin(), goodbye.view().end(),
            more.begin() + static_cast<std::ptrdiff_t>(wire::kPartHeaderSize));
  text("more", {more});
}

/// Of one end of a connection: frames in their order.
viewer::Bytes said(const std::vector<wire::Message>& messages, std::uint32_t session) {
  viewer::Bytes stream;
  std::uint64_t sequence = 0;
  for (const wire::Message& message : messages) {
    const bool greets = std::holds_alternative<wire::Hello>(message);
    const wire::FrameBytes frame =
        wire::encode_frame(message, greets ? 0 : session, sequence++, 1000);
    stream.insert(stream.end(), frame.view().begin(), frame.view().end());
  }
  return stream;
}

void write_sessions(const Seeds& seeds) {
  const wire::Hello hello{.capabilities = 0x1F, .name = "bridge"};
  const StylusSample sample{.sequence = 3, .tip = Vector3(0.01, 0.02, 0.03)};
  seeds.write(
      "bridge_session", "whole",
      said({hello, wire::SampleMessage{.sample = sample}, wire::Report{},
            wire::AppliedForcesMessage{0, {.step = 102, .count = 3, .past = {}}}, wire::Goodbye{}},
           fuzz::kFuzzedSession));
  const auto bridge_says = [&](const std::string& name, std::vector<wire::Message> messages) {
    messages.insert(messages.begin(), hello);
    seeds.write("bridge_session", name, said(messages, fuzz::kFuzzedSession));
  };
  bridge_says("twice",
              {wire::SampleMessage{.sample = sample}, wire::SampleMessage{.sample = sample}});
  bridge_says("silent", {wire::SampleMessage{.sample = sample}});
  bridge_says("yields", {wire::SampleMessage{.sample = sample}, wire::Report{}});
  bridge_says("fast", std::vector<wire::Message>(30, wire::Report{}));
  bridge_says("hello_again", {hello});
  bridge_says("status", {wire::Status{}});
  bridge_says("others_sample", {wire::SampleMessage{.stylus = 3, .sample = sample}});
  bridge_says("others_forces",
              {wire::AppliedForcesMessage{3, {.step = 1, .count = 1, .past = {}}}});
  bridge_says("others_report", {wire::Report{.stylus = 3}});
  seeds.write("bridge_session", "no_hello", said({wire::Report{}}, 0));
  seeds.write("bridge_session", "many", said({wire::Hello{.styluses = 9}}, 0));
  const wire::Welcome welcome{.capabilities = 0xF, .session = 9, .dt = 0.002};
  const auto force = [](std::uint64_t step) {
    return wire::ForceMessage{
        .force = {.force_step = step, .sample_sequence = 5, .force = Vector3(0.5, 0, -1)}};
  };
  viewer::Bytes whole = {0};
  const viewer::Bytes stream =
      said({welcome, force(5), force(9), wire::ContactModelMessage{0, wall()},
            wire::Status{.steps = 9}, wire::Goodbye{}},
           9);
  whole.insert(whole.end(), stream.begin(), stream.end());
  seeds.write("server_session", "whole", whole);
  viewer::Bytes unended(whole.begin(), whole.end() - wire::kHeaderSize - 4);  // no Goodbye
  seeds.write("server_session", "silent", unended);
  unended[0] = 2;
  seeds.write("server_session", "stopped", unended);
  viewer::Bytes untrue_model = {0};
  const viewer::Bytes models = said({welcome, wire::ContactModelMessage{0, untrue()[0]}, hello}, 9);
  untrue_model.insert(untrue_model.end(), models.begin(), models.end());
  seeds.write("server_session", "untrue_model", untrue_model);
  viewer::Bytes refused = {1};
  const viewer::Bytes refusal =
      said({wire::Refuse{.reason = wire::RefuseReason::kTooManyStyluses, .text = "no"}}, 0);
  refused.insert(refused.end(), refusal.begin(), refusal.end());
  seeds.write("server_session", "refused", refused);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const Seeds seeds(argv[1]);
  write_client_messages(seeds);
  write_server_messages(seeds);
  write_wire_frames(seeds);
  write_datagrams(seeds);
  write_contact_models(seeds);
  write_sessions(seeds);
  return 0;
}
