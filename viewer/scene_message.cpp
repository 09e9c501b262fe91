#include "viewer/scene_message.hpp"

#include <cmath>

#include "common/error.hpp"
#include "common/response/stored_response.hpp"
#include "common/secret/secret_file.hpp"
#include "common/utf8.hpp"
#include "simulation/contact/fingertip_loads.hpp"
#include "simulation/step/default_fingertip.hpp"
#include "viewer/display_message.hpp"
#include "viewer/message_parts.hpp"
#include "viewer/scene_regions.hpp"

namespace irdm {
namespace {

// The first fingertip of the scene, else the one that a stylus has by default.
double felt_radius(const SimulationConfig& config) {
  for (const SimulationStylus& stylus : config.styluses) {
    if (!stylus.tool && !stylus.has_ball() && stylus.radius > 0) return stylus.radius;
  }
  return default_fingertip(config);
}

std::vector<float> felt_compliance(const Model& model, double radius) {
  const RestSurface surface(model.mesh);
  const Eigen::VectorXf values =
      static_compliance(model, fingertip_loads(surface, radius)).cast<float>();
  return {values.begin(), values.end()};
}

viewer::SceneObject viewer_object(const std::string& name, const Model& model, double radius) {
  viewer::SceneObject object;
  object.name = name;
  object.rest.resize(model.mesh.surface_node_count(), 3);
  for (int node = 0; node < model.mesh.surface_node_count(); ++node) {
    object.rest.row(node) = model.mesh.rest_position(node).transpose();
  }
  object.triangles = model.mesh.triangles;
  object.mass = static_cast<float>(model.body.mass);
  object.stiffness = static_cast<float>(model.material.youngs_modulus);
  object.compliance = felt_compliance(model, radius);
  object.regions = viewer::scene_regions(model);
  object.display = model.display;
  return object;
}

}  // namespace

viewer::Scene viewer_scene(const std::vector<std::string>& names, const SimulationConfig& config) {
  viewer::Scene seen;
  seen.dt = config.objects.at(0).model->dt;
  seen.floor = config.floor;
  seen.scenery = config.scenery;
  seen.styluses = config.styluses;
  const double radius = felt_radius(config);
  for (std::size_t i = 0; i < config.objects.size(); ++i) {
    seen.objects.push_back(viewer_object(names.at(i), *config.objects[i].model, radius));
  }
  return seen;
}

void load_tokens(ViewerConfig& config) {
  if (config.token_file) config.token = read_token_file(*config.token_file);
  if (config.onlooker_token_file) {
    config.onlooker_token = read_token_file(*config.onlooker_token_file);
  }
  if (!config.token.empty() && config.token == config.onlooker_token) {
    throw Error("viewer.onlooker_token", "is the token itself", "give another one");
  }
}

viewer::ViewerSettings viewer_settings(const ViewerConfig& config) {
  viewer::ViewerSettings settings;
  settings.address = config.address;
  settings.port = static_cast<std::uint16_t>(config.port);
  settings.token = config.token;
  settings.onlooker_token = config.onlooker_token;
  settings.page = viewer::PageFiles::read(viewer::page_folder());
  return settings;
}

std::vector<SettingsChoice> settings_choices(const SimulationConfig& config) {
  std::vector<SettingsChoice> choices;
  for (std::size_t i = 0; i < config.objects.size(); ++i) {
    choices.push_back(settings_choice(config, i));
  }
  return choices;
}

}  // namespace irdm

namespace irdm::viewer {
namespace {

constexpr int kLockstepFlag = 1;
constexpr int kFloorFlag = 2;
constexpr int kViewerStylusFlag = 4;
constexpr int kRecordedFlag = 8;

constexpr int kUnlistedFlag = 1;
constexpr int kFacesLeftOutFlag = 2;
constexpr int kDisplayFlag = 4;

std::uint16_t flags_of(const SceneObject& object) {
  return static_cast<std::uint16_t>((object.regions.some_unlisted ? kUnlistedFlag : 0) |
                                    (object.regions.faces_left_out ? kFacesLeftOutFlag : 0) |
                                    (object.display.empty() ? 0 : kDisplayFlag));
}

void put_triangles(Writer& writer, const Triangles& triangles) {
  for (Eigen::Index i = 0; i < triangles.size(); ++i) {
    writer.put(static_cast<std::uint32_t>(triangles.data()[i]));
  }
}

void put_points(Writer& writer, const Points& points) {
  for (Eigen::Index i = 0; i < points.size(); ++i) {
    writer.put(static_cast<float>(points.data()[i]));
  }
}

Triangles get_triangles(Reader& reader, std::uint32_t count, std::uint32_t nodes) {
  reader.expect(count, 12);
  Triangles triangles(count, 3);
  for (Eigen::Index i = 0; i < triangles.size(); ++i) {
    const auto node = reader.get<std::uint32_t>();
    if (node >= nodes) throw MessageError("a triangle has a node that is not there");
    triangles.data()[i] = static_cast<int>(node);
  }
  return triangles;
}

Points get_points(Reader& reader, std::uint32_t count) {
  reader.expect(count, 12);
  Points points(count, 3);
  for (Eigen::Index i = 0; i < points.size(); ++i) {
    points.data()[i] = static_cast<double>(reader.get_single());
  }
  return points;
}

std::vector<float> get_singles(Reader& reader, std::size_t count) {
  reader.expect(count, 4);
  std::vector<float> values;
  for (std::size_t i = 0; i < count; ++i) values.push_back(reader.get_single());
  return values;
}

/// Of an object that has some.
void put_regions(Writer& writer, const SceneRegions& regions) {
  for (const SceneRegion& region : regions.regions) {
    writer.put(region.number);
    for (const Span& span : {region.youngs_modulus, region.poisson_ratio, region.density}) {
      writer.put(span.lowest);
      writer.put(span.highest);
    }
  }
  for (const float modulus : regions.surface_modulus) writer.put(modulus);
  writer.put(static_cast<std::uint32_t>(regions.nodes.rows()));
  writer.put(static_cast<std::uint32_t>(regions.faces.rows()));
  put_points(writer, regions.nodes);
  put_triangles(writer, regions.faces);
  for (const float modulus : regions.face_modulus) writer.put(modulus);
}

void require_modulus(float value) {
  if (!(std::isfinite(value) && value > 0.0F)) throw MessageError("a number is out of range");
}

Span get_span(Reader& reader) {
  const float lowest = reader.get_single();
  const Span span{lowest, reader.get_single()};
  if (!(span.lowest <= span.highest)) throw MessageError("a number is out of range");
  return span;
}

SceneRegion get_region(Reader& reader) {
  SceneRegion region;
  region.number = reader.get<std::uint32_t>();
  region.youngs_modulus = get_span(reader);
  require_modulus(region.youngs_modulus.lowest);
  require_modulus(region.youngs_modulus.highest);
  region.poisson_ratio = get_span(reader);
  region.density = get_span(reader);
  return region;
}

/// @param triangles of the object's surface
SceneRegions get_regions(Reader& reader, std::size_t count, int flags, std::size_t triangles) {
  SceneRegions regions;
  regions.some_unlisted = (flags & kUnlistedFlag) != 0;
  regions.faces_left_out = (flags & kFacesLeftOutFlag) != 0;
  for (std::size_t i = 0; i < count; ++i) regions.regions.push_back(get_region(reader));
  regions.surface_modulus = get_singles(reader, triangles);
  const auto nodes = reader.get<std::uint32_t>();
  const auto faces = reader.get<std::uint32_t>();
  if (faces > kMaxRegionFaces) throw MessageError("a count is out of range");
  regions.nodes = get_points(reader, nodes);
  regions.faces = get_triangles(reader, faces, nodes);
  regions.face_modulus = get_singles(reader, faces);
  for (const float modulus : regions.surface_modulus) {
    if (!std::isnan(modulus)) require_modulus(modulus);
  }
  for (const float modulus : regions.face_modulus) require_modulus(modulus);
  return regions;
}

void put_object(Writer& writer, const SceneObject& object) {
  const std::string name = as_utf8(object.name, kMaxNameLength);
  writer.put(static_cast<std::uint32_t>(object.rest.rows()));
  writer.put(static_cast<std::uint32_t>(object.triangles.rows()));
  writer.put(static_cast<std::uint32_t>(name.size()));
  writer.put(object.mass);
  writer.put(object.stiffness);
  writer.put(static_cast<std::uint16_t>(object.regions.regions.size()));
  writer.put(flags_of(object));
  writer.put_text(name);
  writer.align();
  put_points(writer, object.rest);
  put_triangles(writer, object.triangles);
  const auto nodes = static_cast<std::size_t>(object.rest.rows());
  for (std::size_t i = 0; i < nodes; ++i) {
    writer.put(i < object.compliance.size() ? object.compliance[i]
                                            : std::numeric_limits<float>::quiet_NaN());
  }
  if (!object.regions.empty()) put_regions(writer, object.regions);
  if (!object.display.empty()) put_display(writer, object.display);
}

SceneObject get_object(Reader& reader) {
  SceneObject object;
  const auto nodes = reader.get<std::uint32_t>();
  const auto triangles = reader.get<std::uint32_t>();
  const auto length = reader.get<std::uint32_t>();
  if (length > kMaxNameLength) throw MessageError("a name is too long");
  object.mass = reader.get_single();
  object.stiffness = reader.get_single();
  const std::size_t regions = reader.get<std::uint16_t>();
  const int flags = reader.get<std::uint16_t>();
  if (regions > kMaxRegions) throw MessageError("a count is out of range");
  object.name = reader.get_text(length);
  reader.align();
  object.rest = get_points(reader, nodes);
  object.triangles = get_triangles(reader, triangles, nodes);
  object.compliance = get_singles(reader, nodes);
  if (regions > 0) object.regions = get_regions(reader, regions, flags, triangles);
  if ((flags & kDisplayFlag) != 0) object.display = get_display(reader, nodes);
  return object;
}

Vector3 sizes(const PlaneShape& /*plane*/) {
  return Vector3::Zero();
}
Vector3 sizes(const BoxShape& box) {
  return box.size;
}
Vector3 sizes(const SphereShape& sphere) {
  return {sphere.radius, 0.0, 0.0};
}
Vector3 sizes(const CapsuleShape& capsule) {
  return {capsule.radius, capsule.length, 0.0};
}
Vector3 sizes(const MeshShape& /*mesh*/) {
  return Vector3::Zero();
}

void put_surface(Writer& writer, const RestSurface& surface) {
  writer.put(static_cast<std::uint32_t>(surface.node_count()));
  writer.put(static_cast<std::uint32_t>(surface.triangle_count()));
  for (int i = 0; i < surface.node_count(); ++i) {
    writer.put(Eigen::Vector3f(surface.node(i).cast<float>()));
  }
  for (int t = 0; t < surface.triangle_count(); ++t) {
    for (const int node : surface.topology().corners(t)) {
      writer.put(static_cast<std::uint32_t>(node));
    }
  }
}

MeshShape get_surface(Reader& reader) {
  const auto nodes = reader.get<std::uint32_t>();
  const auto triangles = reader.get<std::uint32_t>();
  if (triangles == 0) throw MessageError("a mesh has no triangles");
  ModelMesh mesh;
  reader.expect(nodes, 12);
  mesh.nodes.resize(nodes, 3);
  for (Eigen::Index i = 0; i < mesh.nodes.rows(); ++i) {
    mesh.nodes.row(i) = reader.get_single_vector().cast<double>().transpose();
    mesh.surface_nodes.push_back(static_cast<int>(i));
  }
  mesh.triangles = get_triangles(reader, triangles, nodes);
  return {std::make_shared<const RestSurface>(mesh)};
}

/// @param number of the shape among those of SceneryShape
SceneryShape shape_of(int number, const Vector3& size) {
  switch (number) {
    case 0:
      return PlaneShape{};
    case 1:
      return BoxShape{size};
    case 2:
      return SphereShape{size.x()};
    case 3:
      return CapsuleShape{size.x(), size.y()};
    case 4:
      return MeshShape{};  // its surface follows the name
    default:
      throw MessageError("a shape is unknown");
  }
}

void put_scenery(Writer& writer, const SceneryConfig& scenery) {
  const std::string name = as_utf8(scenery.name, kMaxNameLength);
  const Vector3 size = std::visit([](const auto& shape) { return sizes(shape); }, scenery.shape);
  writer.put(static_cast<std::uint16_t>(scenery.shape.index()));
  writer.put(static_cast<std::uint16_t>(name.size()));
  writer.put(Eigen::Vector3f(size.cast<float>()));
  writer.put(scenery.position);
  put_orientation(writer, scenery.orientation);
  writer.put_text(name);
  writer.align();
  const auto* const mesh = std::get_if<MeshShape>(&scenery.shape);
  if (mesh != nullptr) put_surface(writer, *mesh->surface);
}

SceneryConfig get_scenery(Reader& reader) {
  SceneryConfig scenery;
  const int shape = reader.get<std::uint16_t>();
  const auto length = reader.get<std::uint16_t>();
  if (length > kMaxNameLength) throw MessageError("a name is too long");
  scenery.shape = shape_of(shape, reader.get_single_vector().cast<double>());
  scenery.position = reader.get_vector();
  scenery.orientation = get_orientation(reader);
  scenery.name = reader.get_text(length);
  reader.align();
  if (std::holds_alternative<MeshShape>(scenery.shape)) scenery.shape = get_surface(reader);
  return scenery;
}

}  // namespace

Bytes encode(const Scene& scene) {
  Bytes bytes;
  Writer writer(bytes);
  put_header(writer, Type::kScene);
  writer.put(static_cast<std::uint16_t>(scene.objects.size()));
  writer.put(static_cast<std::uint16_t>(scene.styluses.size()));
  const int flags = (scene.lockstep ? kLockstepFlag : 0) | (scene.floor ? kFloorFlag : 0) |
                    (scene.viewer_stylus ? kViewerStylusFlag : 0) |
                    (scene.recorded ? kRecordedFlag : 0);
  writer.put(static_cast<std::uint16_t>(flags));
  writer.put(static_cast<std::uint16_t>(scene.scenery.size()));
  writer.put(scene.dt);
  writer.put(scene.floor ? scene.floor->normal : Vector3::Zero().eval());
  writer.put(scene.floor ? scene.floor->height : 0.0);
  for (const SimulationStylus& stylus : scene.styluses) {
    writer.put(static_cast<float>(stylus.radius));
    writer.put(static_cast<float>(stylus.coupling_stiffness));
    writer.put(static_cast<float>(stylus.reach));
    writer.put(scene.viewer_stylus && &stylus == &scene.styluses.back() ? scene.max_force : 0.0F);
    writer.put(static_cast<std::uint32_t>(stylus.has_ball() ? 1 : 0));
  }
  for (const SceneObject& object : scene.objects) put_object(writer, object);
  for (const SceneryConfig& scenery : scene.scenery) put_scenery(writer, scenery);
  return bytes;
}

Scene decode_scene(std::span<const std::uint8_t> bytes) {
  Reader reader(bytes);
  expect_type(reader, Type::kScene);
  Scene scene;
  const std::size_t objects = get_count(reader, kMaxObjects);
  const std::size_t styluses = get_count(reader, kMaxStyluses);
  const int flags = reader.get<std::uint16_t>();
  const std::size_t scenery = reader.get<std::uint16_t>();
  if (scenery > kMaxScenery) throw MessageError("a count is out of range");
  scene.lockstep = (flags & kLockstepFlag) != 0;
  scene.viewer_stylus = (flags & kViewerStylusFlag) != 0;
  scene.recorded = (flags & kRecordedFlag) != 0;
  scene.dt = reader.get_double();
  FloorConfig floor;
  floor.normal = reader.get_vector();
  floor.height = reader.get_double();
  if ((flags & kFloorFlag) != 0) scene.floor = floor;
  for (std::size_t s = 0; s < styluses; ++s) {
    SimulationStylus& stylus = scene.styluses.emplace_back();
    stylus.radius = static_cast<double>(reader.get_single());
    stylus.coupling_stiffness = static_cast<double>(reader.get_single());
    stylus.reach = static_cast<double>(reader.get_single());
    scene.max_force = reader.get_single();
    const auto kind = reader.get<std::uint32_t>();
    if (kind > 1) throw MessageError("a stylus is of an unknown kind");
    stylus.ball = kind == 1;
  }
  for (std::size_t i = 0; i < objects; ++i) scene.objects.push_back(get_object(reader));
  for (std::size_t i = 0; i < scenery; ++i) scene.scenery.push_back(get_scenery(reader));
  reader.finish();
  return scene;
}

}  // namespace irdm::viewer
