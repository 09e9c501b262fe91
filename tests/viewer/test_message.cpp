#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>

#include "tests/support/catch.hpp"
#include "tests/viewer/frames.hpp"
#include "viewer/scene_message.hpp"

using namespace irdm;
using namespace irdm::test;
using namespace irdm::viewer;

namespace {

Bytes frame_bytes(const SurfaceFrame& frame) {
  Bytes bytes(7, 0xAA);  // what was there before goes
  encode(frame, bytes);
  return bytes;
}

SettingsRequest example_settings() {
  SettingsRequest request;
  request.objects = 1;
  request.settings.gravity = Vector3(0, -1, 0);
  request.settings.object[0] = {{1.0, 0.5}, {2.0, 4.0}, {8.0, 0.25}, 0.5, true};
  return request;
}

const char* const kSettingsHex =
    "0000000000000000 000000000000f0bf 0000000000000000 | 000000000000f03f 000000000000e03f"
    "0000000000000040 0000000000001040 0000000000002040 000000000000d03f 000000000000e03f"
    "01 00 00000000000000000000000000000000000000000000";

SurfaceFrame one_point_frame(const Vector3& displacement) {
  SurfaceFrame frame;
  frame.force_step = 2;
  frame.time = 0.5;
  StylusRecord stylus;
  stylus.present = true;
  stylus.contact = ContactState::kTouching;
  stylus.object = 0;
  stylus.buttons = 1;
  stylus.tip = Vector3(1, 2, -1);
  stylus.proxy = Vector3(0, 0.5, 0);
  stylus.force = Vector3(0, 2, -0.5);
  frame.styluses = {stylus};
  frame.contacts = {{Vector3(0.25, 0, 1), true}};
  StepRecord record;
  record.force_step = 2;
  record.stylus[0] = stylus;
  frame.trail.follow(record);
  ObjectSurface surface;
  surface.position = Vector3(1, 0, 0);
  surface.displacement = displacement.transpose();
  frame.objects = {surface};
  return frame;
}

double quantisation_error(double size) {
  const Scene scene = example_scene();
  const SurfaceFrame frame = example_frame(scene, size);
  const SurfaceFrame back = decode_frame(frame_bytes(frame), node_counts(scene));
  double error = 0.0;
  for (std::size_t i = 0; i < frame.objects.size(); ++i) {
    const Points difference = back.objects[i].displacement - frame.objects[i].displacement;
    error = std::max(error, difference.cwiseAbs().maxCoeff());
  }
  return error;
}

/// Each way to spoil these bytes ends in an answer or in MessageError, never otherwise.
void check_survives(const Bytes& good, const std::function<void(const Bytes&)>& decode) {
  std::mt19937 random(7);
  const auto any = [&random](std::size_t below) {
    return std::uniform_int_distribution<std::size_t>(0, below - 1)(random);
  };
  for (int round = 0; round < 20'000; ++round) {
    Bytes bytes = good;
    for (std::size_t i = any(4); i > 0; --i) {
      bytes[any(std::min<std::size_t>(bytes.size(), 200))] = static_cast<std::uint8_t>(any(256));
    }
    if (any(4) == 0) bytes.resize(any(bytes.size() + 8));
    try {
      decode(bytes);
    } catch (const MessageError&) {
    }
  }
}

}  // namespace

TEST_CASE("a scene's bytes are those of the document") {
  CHECK(encode(one_point_scene()) ==
        from_hex("49525657 0100 0100 | 0100 0100 00000000 | fca9f1d24d62603f"
                 "0000000000000000 0000000000000000 0000000000000000 | 0000000000000000"
                 "0000003f 0000fa44 0000803e 00000000 00000000 |"
                 "01000000 01000000 02000000 0000003f 0000fa44 00000000 61620000"
                 "0000003f 000080bf 00000040 | 00000000 00000000 00000000 | 0000803e"));
}

TEST_CASE("a frame's bytes are those of the document") {
  const Bytes bytes = frame_bytes(one_point_frame(Vector3(0, 0, 0)));
  CHECK(bytes ==
        from_hex("49525657 0100 0200 | 0100 0100 0100 0000 0200000000000000 000000000000e03f |"
                 "01 01 0000 01000000 000000000000f03f 0000000000000040 000000000000f0bf"
                 "0000000000000000 000000000000e03f 0000000000000000"
                 "00000000 00000040 000000bf 0000803e 00000000 0000803f 01 00000000000000 |"
                 "00000000 00000040 000000bf |"
                 "000000000000f03f 0000000000000000 0000000000000000"
                 "0000803f 00000000 00000000 00000000 02 000000 ccbc8c2b"
                 "0000 0000 0000 0000"));
}

TEST_CASE("scenery's bytes are those of the document") {
  Scene scene = one_point_scene();
  const std::size_t before = encode(scene).size();
  scene.scenery = example_scenery();
  const Bytes bytes = encode(scene);
  CHECK(Bytes(bytes.begin() + 12, bytes.begin() + 16) == from_hex("0000 0400"));
  CHECK(added_after(bytes, before) ==
        from_hex("0000 0600 00000000 00000000 00000000"
                 "0000000000000000 b81e85eb51b8aebf 0000000000000000"
                 "0000003f 0000003f 000000bf 0000003f 77c3a46e64650000 |"
                 "0100 0300 0000003f 0000803e 0000003e"
                 "000000000000f03f 0000000000000040 0000000000000840"
                 "00000000 0000803f 00000000 00000000 626f7800 |"
                 "0200 0400 0000803d 00000000 00000000"
                 "9a9999999999b93f 0000000000000000 9a9999999999c9bf"
                 "0000803f 00000000 00000000 00000000 62616c6c |"
                 "0300 0700 0000803e 0000403f 00000000"
                 "0000000000000000 333333333333d3bf 0000000000000000"
                 "0000003f 0000003f 000000bf 0000003f 63617073756c6500"));
}

TEST_CASE("a mesh of scenery follows its name") {
  Scene scene = one_point_scene();
  const std::size_t before = encode(scene).size();
  SceneryConfig bowl;
  bowl.name = "bowl";
  const Model cube = synthetic_cube(1, 1, 1);
  bowl.shape = MeshShape{std::make_shared<const RestSurface>(cube.mesh)};
  scene.scenery = {bowl};
  Bytes bytes = encode(scene);
  const std::size_t mesh = before + 60;
  REQUIRE(bytes.size() == mesh + 8 + 8 * 12 + 12 * 12);
  CHECK(Bytes(bytes.begin() + static_cast<std::ptrdiff_t>(before),
              bytes.begin() + static_cast<std::ptrdiff_t>(before) + 4) == from_hex("0400 0400"));
  CHECK(Bytes(bytes.begin() + static_cast<std::ptrdiff_t>(mesh),
              bytes.begin() + static_cast<std::ptrdiff_t>(mesh) + 8) ==
        from_hex("08000000 0c000000"));
  const Scene back = decode_scene(bytes);
  const RestSurface& surface = *std::get<MeshShape>(back.scenery.at(0).shape).surface;
  REQUIRE(surface.node_count() == 8);
  for (int i = 0; i < 8; ++i) {
    CHECK((surface.node(i) - cube.mesh.rest_position(i)).norm() < 1e-8);
  }
  CHECK(surface.topology().corners(11) == std::array{cube.mesh.triangles(11, 0),
                                                     cube.mesh.triangles(11, 1),
                                                     cube.mesh.triangles(11, 2)});
  SECTION("a node that is not there") {
    bytes[bytes.size() - 4] = 8;
  }
  SECTION("no triangles") {
    bytes[mesh + 4] = 0;
  }
  SECTION("more triangles than bytes") {
    bytes[mesh + 4] = 13;
  }
  CHECK_THROWS_AS(decode_scene(bytes), MessageError);
}

TEST_CASE("a display mesh follows its object, and damage to it is an error") {
  Scene scene = one_point_scene();
  const std::size_t before = encode(scene).size();
  const DisplayMesh display = example_display();
  scene.objects[0].display = display;
  const Bytes bytes = encode(scene);
  const std::size_t counts = before;
  CHECK(bytes.size() - before == 16 + 4 * (12 + 12 + 12 + 12 + 8) + 2 * 12 + 8);
  CHECK(std::vector<int>(bytes.begin() + static_cast<long>(counts),
                         bytes.begin() + static_cast<long>(counts) + 16) ==
        std::vector<int>{4, 0, 0, 0, 2, 0, 0, 0, 1, 0, 0, 0, 5, 0, 0, 0});
  const DisplayMesh back = decode_scene(bytes).objects.at(0).display;
  CHECK(back.positions == display.positions);
  CHECK(back.normals == display.normals);
  CHECK(back.triangles == display.triangles);
  CHECK(back.nodes == display.nodes);
  CHECK(back.weights == display.weights);
  CHECK(back.texture_coordinates == display.texture_coordinates);
  CHECK(back.texture == display.texture);

  const auto refused = [&](const std::function<void(DisplayMesh&)>& damage) {
    scene.objects[0].display = display;
    damage(scene.objects[0].display);
    CHECK_THROWS_AS(decode_scene(encode(scene)), MessageError);
  };
  refused([](DisplayMesh& mesh) { mesh.triangles(1, 2) = 4; });
  refused([](DisplayMesh& mesh) { mesh.triangles(1, 2) = -1; });
  refused([](DisplayMesh& mesh) { mesh.nodes(3, 0) = 1000; });
  refused([](DisplayMesh& mesh) { mesh.weights(0, 0) = -0.5F; });
  refused([](DisplayMesh& mesh) { mesh.weights(0, 0) = 0.9F; });
  refused([](DisplayMesh& mesh) { mesh.normals(0, 2) = 2.0F; });
  refused([](DisplayMesh& mesh) { mesh.positions(0, 0) = std::nanf(""); });
  refused([](DisplayMesh& mesh) { mesh.texture_coordinates(0, 0) = std::nanf(""); });
  refused([](DisplayMesh& mesh) { mesh.texture = {1, 2, 3}; });
  refused([](DisplayMesh& mesh) { mesh.texture_coordinates.resize(0, 2); });
  for (std::size_t length = before; length < bytes.size(); length += 7) {
    CHECK_THROWS_AS(decode_scene(std::span(bytes).first(length)), MessageError);
  }
}

TEST_CASE("viewers are sent the floor and the scenery of the simulation") {
  SimulationConfig config;
  config.objects.resize(1);
  config.objects[0].model = std::make_shared<const Model>(synthetic_cube(2, 1, 1));
  config.floor = FloorConfig{Vector3(0, 1, 0), -0.06, {}};
  config.scenery = example_scenery();
  const Scene scene = viewer_scene({"cube"}, config);
  CHECK(scene.floor->height == -0.06);
  REQUIRE(scene.scenery.size() == 4);
  CHECK(scene.scenery[2].name == "ball");
  CHECK(scene.objects[0].regions.empty());
}

TEST_CASE("the bytes of a contact between bodies are those of the document") {
  SurfaceFrame frame = one_point_frame(Vector3::Zero());
  BodyContactRecord contact;
  contact.other = -3;
  contact.normal = Vector3(0, 1, -0.5);
  contact.position = Vector3(1, 0.5, -2);
  contact.force = Vector3(0, 4, 0.25);
  contact.area = 0.125;
  const std::size_t before = frame_bytes(frame).size();
  frame.body_contacts = {contact};
  const Bytes bytes = frame_bytes(frame);
  CHECK(Bytes(bytes.begin() + 12, bytes.begin() + 16) == from_hex("0100 0100"));
  CHECK(added_after(bytes, before) == from_hex("00 fd 0000 ff7f 00c0 | 0000803f 0000003f 000000c0"
                                               "00000000 00008040 0000803e 0000003e"));
}

TEST_CASE("contacts that are too many, or of bodies that are not there, are refused") {
  const std::size_t one = 1;
  SurfaceFrame frame = one_point_frame(Vector3::Zero());
  frame.body_contacts.resize(kMaxBodyContacts);
  for (BodyContactRecord& contact : frame.body_contacts) contact.other = -1;
  CHECK_NOTHROW(decode_frame(frame_bytes(frame), {&one, 1}));
  SECTION("too many") {
    frame.body_contacts.push_back(frame.body_contacts.back());
  }
  SECTION("no such object") {
    frame.body_contacts.back().object = 1;
  }
  SECTION("no such other object") {
    frame.body_contacts.back().other = 1;
  }
  SECTION("no such scenery") {
    frame.body_contacts.back().other = -1 - static_cast<int>(kMaxScenery) - kMaxStyluses;
  }
  CHECK_THROWS_AS(decode_frame(frame_bytes(frame), {&one, 1}), MessageError);
}

TEST_CASE("scenery that is too much, or of no known shape, is refused") {
  Scene scene = one_point_scene();
  const std::size_t before = encode(scene).size();
  scene.scenery.resize(kMaxScenery);
  CHECK_NOTHROW(decode_scene(encode(scene)));
  Bytes bytes = encode(scene);
  bytes[before] = 5;
  CHECK_THROWS_AS(decode_scene(bytes), MessageError);
  scene.scenery.resize(kMaxScenery + 1);
  CHECK_THROWS_AS(decode_scene(encode(scene)), MessageError);
}

TEST_CASE("displacements beyond 32.8 cm take four bytes, in units of 0.01 mm") {
  const Bytes bytes = frame_bytes(one_point_frame(Vector3(1.0, -2.0, 0.0)));
  REQUIRE(bytes.size() == 32 + 88 + 12 + 48 + 12);
  CHECK(Bytes(bytes.begin() + 172, bytes.end()) ==
        from_hex("04 000000 abc52737 | a0860100 c0f2fcff 00000000"));
}

TEST_CASE("health's bytes are those of the document") {
  Health health;
  health.steps = 1;
  health.step_time = {1.0F, 2.0F, 4.0F};
  health.missed = 2;
  health.unsolved = 3;
  health.resets = 4;
  health.lost_steps = 5;
  health.surface_rate = 0.5F;
  health.viewers = 6;
  health.sessions = 7;
  health.samples = 8;
  health.forces = 9;
  health.forces_replaced = 10;
  health.protocol_errors = 11;
  health.links = {{true, {1.0F, 2.0F, 4.0F}, {0.5F, 1.0F, 2.0F}}, {}};
  const Bytes bytes = encode(health);
  CHECK(bytes ==
        from_hex("49525657 0100 0300 0100000000000000 0000803f 00000040 00008040"
                 "0000c07f 0000c07f 0000c07f 0200000000000000 0300000000000000"
                 "0400000000000000 0500000000000000 0000003f 06000000"
                 "0700000000000000 0800000000000000 0900000000000000"
                 "0a00000000000000 0b00000000000000 0200 000000000000"
                 "01000000 0000803f 00000040 00008040 0000003f 0000803f 00000040 00000000"
                 "00000000 0000c07f 0000c07f 0000c07f 0000c07f 0000c07f 0000c07f 00000000"));
  CHECK(encode(decode_health(bytes)) == bytes);
}

TEST_CASE("state's bytes are those of the document") {
  State state;
  state.looks_on = true;
  state.playing = true;
  state.settings_changes = 2;
  state.length = 2.0;
  state.speed = 0.5;
  state.shown = 1;
  state.recordings = {{1, "a.h5"}};
  state.has_scenes = true;
  state.preparing = true;
  state.scenes = {"b.h5", ""};
  state.scene = 1;
  state.notice = "hm";
  state.settings = example_settings().settings;
  state.choices = {{false, false, true}};
  const std::string zeros(2 * 60, '0');
  CHECK(encode(state) ==
        from_hex("49525657 0100 0400 41050000 02000000 0000000000000040 000000000000e03f"
                 "0100 0100 0200 0200 0100 000000000000" +
                 std::string(kSettingsHex) + "0100 0400 612e6835" + zeros +
                 "0400 622e6835 0000 686d 0000"));
  CHECK(decode_state(encode(state), 1) == state);
  const State all = example_state();
  CHECK(decode_state(encode(all), 2) == all);
}

TEST_CASE("a viewer's messages are those of the document") {
  const auto same = [](const ClientMessage& message, const std::string& hex) {
    CHECK(encode(message) == from_hex(hex));
    CHECK(encode(decode_client(from_hex(hex))) == from_hex(hex));
  };
  same(Hello{"key"}, "49525657 0100 1000 0300 0000 6b6579");
  same(Hello{"key", true}, "49525657 0100 1000 0300 0100 6b6579");
  same(Command{}, "49525657 0100 1100 0100 0000 00000000 0000000000000000");
  same(Command{CommandKind::kSeek, 7, 0.5},
       "49525657 0100 1100 0b00 0700 00000000 000000000000e03f");
  same(StylusRequest{true, 1, Vector3(1, 0, -1)},
       "49525657 0100 1200 01 000000 01000000 000000000000f03f 0000000000000000 000000000000f0bf");
  same(Command{CommandKind::kSaveScene}, "49525657 0100 1100 0d00 0000 00000000 0000000000000000");
  same(SceneRequest{"b.h5"}, "49525657 0100 1400 0400 0000 622e6835");
  same(example_settings(), std::string("49525657 0100 1300 0100 000000000000") + kSettingsHex);
}

TEST_CASE("a viewer's message that breaks the rules is refused") {
  const char* spoilt =
      GENERATE("", "49", "49525658 0100 1100 0100 0000 00000000 0000000000000000",  // magic
               "49525657 0200 1100 0100 0000 00000000 0000000000000000",            // version
               "49525657 0100 0200 0100 0000 00000000 0000000000000000",            // direction
               "49525657 0100 1500 0100 0000 00000000 0000000000000000",            // type
               "49525657 0100 1100 0000 0000 00000000 0000000000000000",            // command
               "49525657 0100 1100 0e00 0000 00000000 0000000000000000",            // command
               "49525657 0100 1100 0400 0000 00000000 0000000000000000",     // no step at all
               "49525657 0100 1100 0b00 0000 00000000 000000000000f0bf",     // before the start
               "49525657 0100 1100 0c00 0000 00000000 0000000000000000",     // speed
               "49525657 0100 1100 0c00 0000 00000000 000000000000f87f",     // NaN
               "49525657 0100 1100 0100 0000 00000000 00000000000000",       // too short
               "49525657 0100 1100 0100 0000 00000000 0000000000000000 00",  // too long
               "49525657 0100 1000 0400 0000 6b6579",                        // token cut
               "49525657 0100 1000 0000 0200",                               // what else
               "49525657 0100 1000 8100 0000",                               // token's length
               "49525657 0100 1200 02 000000 00000000 000000000000f03f 000000000000f03f "
               "000000000000f03f",  // present
               "49525657 0100 1200 01 000000 00000000 000000000000f87f 000000000000f03f "
               "000000000000f03f",                       // NaN
               "49525657 0100 1300 0500 000000000000",   // objects
               "49525657 0100 1400 0000 0000",           // no name
               "49525657 0100 1400 0500 0000 622e6835",  // name cut
               "49525657 0100 1400 0300 0000 622e6835"   // more than the name
      );
  CHECK_THROWS_AS(decode_client(from_hex(spoilt)), MessageError);
}

TEST_CASE("names of scenes that are too long or too many are refused or cut") {
  const std::string longest(kMaxSceneName, 'a');
  const auto request = decode_client(encode(ClientMessage(SceneRequest{longest + "b"})));
  CHECK(std::get<SceneRequest>(request).name == longest);
  CHECK_THROWS_AS(decode_client(encode(ClientMessage(SceneRequest{"caf\xE9.toml"}))), MessageError);
  Bytes bytes = encode(ClientMessage(SceneRequest{longest}));
  bytes[8] = kMaxSceneName + 1;
  bytes.push_back('b');
  CHECK_THROWS_AS(decode_client(bytes), MessageError);
  State state;
  state.scenes.assign(kMaxScenes + 1, longest + "b");
  const State back = decode_state(encode(state), 0);
  CHECK(back.scenes == std::vector<std::string>(kMaxScenes, longest));
  bytes = encode(back);
  SECTION("too many") {
    bytes[38] = kMaxScenes + 1;
  }
  SECTION("too long") {
    bytes[72] = kMaxSceneName + 1;
  }
  CHECK_THROWS_AS(decode_state(bytes, 0), MessageError);
}

TEST_CASE("scenes and frames come back as they went") {
  const Scene scene = example_scene();
  const Scene scene_back = decode_scene(encode(scene));
  CHECK(encode(scene_back) == encode(scene));
  CHECK(scene_back.objects[0].rest == scene.objects[0].rest);
  CHECK(scene_back.objects[1].triangles == scene.objects[1].triangles);
  CHECK(scene_back.objects[0].regions.empty());
  CHECK(scene_back.objects[1].regions.some_unlisted);
  CHECK(scene_back.objects[1].regions.nodes == scene.objects[1].regions.nodes);
  CHECK(scene_back.floor->height == scene.floor->height);
  CHECK(std::get<CapsuleShape>(scene_back.scenery[3].shape).length == 0.75);
  CHECK(scene_back.scenery[3].name == "capsule");
  CHECK(scene_back.scenery[1].position == scene.scenery[1].position);

  const SurfaceFrame frame = example_frame(scene, 0.01);
  const SurfaceFrame back = decode_frame(frame_bytes(frame), node_counts(scene));
  CHECK(back.force_step == 1039);
  CHECK(back.styluses[0].tip == frame.styluses[0].tip);
  CHECK(back.styluses[1].object == -1);
  CHECK(back.trail.count() == ForceTrail::kLength);
  CHECK(back.trail.force(31, 1) == frame.trail.force(31, 1));
  CHECK(back.objects[1].position == frame.objects[1].position);
  CHECK(back.objects[1].orientation.isApprox(frame.objects[1].orientation, 1e-6));
  const BodyContactRecord& contact = frame.body_contacts[1];
  const BodyContactRecord& contact_back = back.body_contacts.at(1);
  CHECK(contact_back.object == 1);
  CHECK(contact_back.other == -4);
  CHECK(contact_back.force.isApprox(contact.force, 1e-6));
  CHECK(contact_back.position.isApprox(contact.position, 1e-6));
  CHECK(contact_back.normal.isApprox(contact.normal, 1e-4));
  CHECK(contact_back.area == Approx(contact.area).epsilon(1e-6));
}

TEST_CASE("a displacement is off by at most half of 0.01 mm, whatever its size") {
  for (const double size : {0.0, 1e-15, 1e-6, 1e-3, 0.05, 0.3276, 0.328, 1.0, 50.0}) {
    CAPTURE(size);
    CHECK(quantisation_error(size) <= 0.5000001 * kCoarsestUnit);
  }
  CHECK(quantisation_error(0.01) <= 0.51 * 0.01 / 32767);
}

TEST_CASE("a displacement that is not finite goes as zero and spoils no other") {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  const std::size_t one = 1;
  const SurfaceFrame back =
      decode_frame(frame_bytes(one_point_frame(Vector3(kInfinite, 0.01, std::nan("")))), {&one, 1});
  const Vector3 u = back.objects[0].displacement.row(0).transpose();
  CHECK(u.x() == 0.0);
  CHECK(u.y() == Approx(0.01));
  CHECK(u.z() == 0.0);
}

TEST_CASE("whatever the bytes are, decoding ends in an answer or in MessageError") {
  const Scene scene = example_scene();
  const auto nodes = node_counts(scene);
  check_survives(encode(scene), [](const Bytes& bytes) { decode_scene(bytes); });
  check_survives(frame_bytes(example_frame(scene, 0.01)),
                 [&](const Bytes& bytes) { decode_frame(bytes, nodes); });
  check_survives(encode(Health{}), [](const Bytes& bytes) { decode_health(bytes); });
  check_survives(encode(ClientMessage(Hello{"token"})),
                 [](const Bytes& bytes) { decode_client(bytes); });
  check_survives(encode(ClientMessage(Command{})),
                 [](const Bytes& bytes) { decode_client(bytes); });
  check_survives(encode(ClientMessage(StylusRequest{})),
                 [](const Bytes& bytes) { decode_client(bytes); });
  check_survives(encode(ClientMessage(example_settings())),
                 [](const Bytes& bytes) { decode_client(bytes); });
  check_survives(encode(ClientMessage(SceneRequest{"press.toml"})),
                 [](const Bytes& bytes) { decode_client(bytes); });
  check_survives(encode(example_state()), [](const Bytes& bytes) { decode_state(bytes, 2); });
}

TEST_CASE("a trail of forces begins anew after a gap") {
  ForceTrail trail;
  StepRecord record;
  for (const std::uint64_t step : {5, 6, 7}) {
    record.force_step = step;
    record.stylus[0].force = Vector3(static_cast<double>(step), 0, 0);
    trail.follow(record);
  }
  CHECK(trail.count() == 3);
  CHECK(trail.force(2, 0).x() == 5.0F);
  record.force_step = 9;
  trail.follow(record);
  CHECK(trail.count() == 1);
  CHECK(trail.newest() == 9);
}
