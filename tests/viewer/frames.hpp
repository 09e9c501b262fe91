#pragma once

#include <cctype>
#include <cstddef>
#include <random>
#include <string>

#include "tests/support/synthetic_model.hpp"
#include "viewer/message.hpp"

namespace irdm::test {

/// "49 52 .." as bytes; '|' and blanks are for the reader.
inline viewer::Bytes from_hex(const std::string& text) {
  viewer::Bytes bytes;
  std::string digits;
  for (const char c : text) {
    if (std::isxdigit(static_cast<unsigned char>(c)) != 0) digits += c;
    if (digits.size() == 2) {
      bytes.push_back(static_cast<std::uint8_t>(std::stoi(digits, nullptr, 16)));
      digits.clear();
    }
  }
  return bytes;
}

/// What is added to a message's first bytes.
inline viewer::Bytes added_after(const viewer::Bytes& bytes, std::size_t first) {
  return {bytes.begin() + static_cast<std::ptrdiff_t>(first), bytes.end()};
}

/// One object of one node and one triangle, one stylus.
inline viewer::Scene one_point_scene() {
  viewer::Scene scene;
  scene.dt = 0.002;
  scene.styluses = {{0.5, 2000.0, 0.25}};
  viewer::SceneObject object{"ab", Points(1, 3), Triangles(1, 3), 0.5F, 2000.0F};
  object.rest << 0.5, -1.0, 2.0;
  object.triangles << 0, 0, 0;
  object.compliance = {0.25F};
  scene.objects = {object};
  return scene;
}

/// Scenery of each shape.
inline std::vector<SceneryConfig> example_scenery() {
  const Quaternion turned(0.5, 0.5, -0.5, 0.5);
  return {{"w\xC3\xA4nde", PlaneShape{}, Vector3(0, -0.06, 0), turned, {}},
          {"box", BoxShape{Vector3(0.5, 0.25, 0.125)}, Vector3(1, 2, 3), {0, 1, 0, 0}, {}},
          {"ball", SphereShape{0.0625}, Vector3(0.1, 0, -0.2), Quaternion::Identity(), {}},
          {"capsule", CapsuleShape{0.25, 0.75}, Vector3(0, -0.3, 0), turned, {}}};
}

/// Of an object of four triangles: two regions, and one triangle between them.
inline viewer::SceneRegions example_regions() {
  viewer::SceneRegions regions;
  regions.regions = {{0, {2000.0F, 2000.0F}, {0.25F, 0.5F}, {1000.0F, 1000.0F}},
                     {3, {500.0F, 8000.0F}, {0.25F, 0.25F}, {1024.0F, 1024.0F}}};
  regions.some_unlisted = true;
  regions.surface_modulus = {2000.0F, 500.0F, 8000.0F, 2000.0F};
  regions.nodes.resize(3, 3);
  regions.nodes << 0.5, 0, 0, 0, 0.5, 0, 0, 0, -0.5;
  regions.faces.resize(1, 3);
  regions.faces << 0, 2, 1;
  regions.face_modulus = {500.0F};
  return regions;
}

/// Two triangles with a texture, bound to the first node of an object.
inline DisplayMesh example_display() {
  DisplayMesh display;
  display.positions.resize(4, 3);
  display.positions << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0.5, 0.25;
  display.normals = DisplayMesh::Rows3::Zero(4, 3);
  display.normals.col(2).setOnes();
  display.triangles.resize(2, 3);
  display.triangles << 0, 1, 2, 0, 2, 3;
  display.nodes = Triangles::Zero(4, 3);
  display.weights.resize(4, 3);
  display.weights.rowwise() = Eigen::RowVector3f(0.5F, 0.375F, 0.125F);
  display.texture_coordinates.resize(4, 2);
  display.texture_coordinates << 0, 0, 1, 0, 1, 1, 0.25, 0.75;
  display.texture = {0xFF, 0xD8, 0xFF, 0xE0, 7};
  return display;
}

/// A scene of a synthetic cube and a single tetrahedron, with two styluses, a floor and scenery.
inline viewer::Scene example_scene() {
  viewer::Scene scene;
  scene.dt = 0.002;
  scene.lockstep = true;
  scene.floor = FloorConfig{Vector3(0, 1, 0), -0.06, {}};
  scene.scenery = example_scenery();
  scene.styluses = {{.radius = 0.01, .coupling_stiffness = 400.0, .ball = true}, {0.0, 0.0, 0.02}};
  const Model cube = synthetic_cube(3, 1, 1);
  viewer::SceneObject first{"w\xC3\xBCrfel", {}, cube.mesh.triangles, 0.19F, 2000.0F};
  first.rest = cube.mesh.nodes.cast<float>().cast<double>();
  viewer::SceneObject second{"tet", Points::Zero(4, 3), Triangles(4, 3), 0.5F, 1e5F};
  second.rest.bottomRows(3).setIdentity();
  second.triangles << 0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3;
  second.regions = example_regions();
  second.display = example_display();
  for (int i = 0; i < first.rest.rows(); ++i) {
    first.compliance.push_back(0.001F * static_cast<float>(i));
  }
  scene.viewer_stylus = true;
  scene.max_force = 3.3F;
  scene.objects = {first, second};
  return scene;
}

inline std::vector<std::size_t> node_counts(const viewer::Scene& scene) {
  std::vector<std::size_t> counts;
  for (const auto& object : scene.objects) {
    counts.push_back(static_cast<std::size_t>(object.rest.rows()));
  }
  return counts;
}

/// A frame of that scene; every number another. @param size of displacements [m]
inline SurfaceFrame example_frame(const viewer::Scene& scene, double size, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto vector = [&] { return Vector3(uniform(random), uniform(random), uniform(random)); };
  SurfaceFrame frame;
  StepRecord record;
  for (record.force_step = 900; record.force_step < 1040; ++record.force_step) {
    record.stylus[0].force = vector();
    record.stylus[1].force = vector();
    frame.trail.follow(record);
  }
  frame.force_step = 1039;
  frame.time = 2.08;
  for (std::size_t s = 0; s < scene.styluses.size(); ++s) {
    StylusRecord stylus = record.stylus[s];
    stylus.present = s == 0;
    stylus.contact = s == 0 ? ContactState::kHeld : ContactState::kFree;
    stylus.object = s == 0 ? 1 : -1;
    stylus.buttons = 5;
    stylus.tip = vector();
    stylus.proxy = vector();
    frame.styluses.push_back(stylus);
    frame.contacts.push_back({vector().cast<float>().cast<double>(), s == 0});
  }
  for (const auto& object : scene.objects) {
    ObjectSurface surface;
    surface.position = vector();
    surface.orientation = Quaternion(uniform(random), uniform(random), uniform(random), 1.0);
    surface.orientation.normalize();
    surface.displacement =
        Points::NullaryExpr(object.rest.rows(), 3, [&] { return size * uniform(random); });
    frame.objects.push_back(surface);
  }
  for (const int other : {0, -4}) {
    BodyContactRecord contact;
    contact.object = 1;
    contact.other = other;
    contact.force = vector();
    contact.position = vector();
    contact.normal = vector().normalized();
    contact.area = 0.0001 + 0.0001 * std::abs(uniform(random));
    frame.body_contacts.push_back(contact);
  }
  return frame;
}

/// A state of that scene.
inline viewer::State example_state() {
  viewer::State state;
  state.stylus_free = true;
  state.paused = true;
  state.playback = true;
  state.can_record = true;
  state.settings_changes = 3;
  state.length = 12.5;
  state.speed = 0.5;
  state.shown = 1;
  state.recordings = {{0, "run-1.h5"}, {1, "l\xC3\xA4ufe.h5"}};
  state.has_scenes = true;
  state.can_load = true;
  state.scenes = {"press.toml", "w\xC3\xBCrfel.h5"};
  state.scene = 1;
  state.notice = "a notice for a person";
  state.settings.gravity = Vector3(0, -9.81, 0);
  state.settings.object[0] = {{0.6, 0.5}, {0.1, 0.2}, {3.0, 0.01}, 2.0, true};
  state.settings.object[1] = {{0.3, 0.3}, {0, 0}, {0, 0}, 1.0, false};
  state.choices = {{true, false, false}, {false, true, true}};
  return state;
}

}  // namespace irdm::test
