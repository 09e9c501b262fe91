#include "scene/scenery_keys.hpp"

#include <cmath>
#include <memory>
#include <string>

#include "common/config/range.hpp"
#include "common/error.hpp"
#include "common/model/model_file.hpp"
#include "scene/common_keys.hpp"

namespace irdm {
namespace {

// The one key of a shape that the table has.
std::string shape_of(const TomlTable& table) {
  std::string found;
  for (const char* shape : {"plane", "box", "sphere", "capsule", "mesh"}) {
    if (!table.has(shape)) continue;
    if (!found.empty()) {
      table.fail(shape, "is a second shape", "leave it out, or give it a [[scenery]] of its own");
    }
    found = shape;
  }
  if (found.empty()) {
    table.fail("", "has no shape", "add one of: plane | box | sphere | capsule | mesh");
  }
  return found;
}

// A rotation from +y to a unit vector. Where -y is nearer, from there, after half a turn: the axis
// of nearly half a turn would be lost in rounding.
Quaternion turned_from_y(const Vector3& to) {
  const Vector3 from = std::copysign(1.0, to.y()) * Vector3::UnitY();
  const Vector3 axis = from.cross(to);
  const Quaternion turn(1.0 + from.dot(to), axis.x(), axis.y(), axis.z());
  const Quaternion half_turn(0.0, 1.0, 0.0, 0.0);
  return (from.y() < 0 ? turn * half_turn : turn).normalized();
}

// The normal of a plane turns it, instead of an orientation.
SceneryShape read_plane(TomlTable& table, TomlTable plane, Quaternion& orientation) {
  if (table.has("orientation")) {
    table.fail("orientation", "is not for a plane", "leave it out, and give plane.normal");
  }
  orientation = turned_from_y(read_normal(plane));
  plane.finish();
  return PlaneShape{};
}

SceneryShape read_box(TomlTable table) {
  const BoxShape box{Vector3(table.numbers("size", 3, lab::kLength).data())};
  table.finish();
  return box;
}

SceneryShape read_sphere(TomlTable table) {
  const SphereShape sphere{table.number("radius", lab::kLength)};
  table.finish();
  return sphere;
}

SceneryShape read_capsule(TomlTable table) {
  CapsuleShape capsule;
  capsule.radius = table.number("radius", lab::kLength);
  capsule.length = table.number("length", lab::kLength);
  table.finish();
  return capsule;
}

std::vector<Waypoint> read_path(TomlTable& motion) {
  std::vector<Waypoint> path;
  for (TomlTable& row : motion.tables("path")) {
    Waypoint& next = path.emplace_back();
    next.time = row.number("time", between(0.0, 1e6));
    next.displacement = read_vector(row, "displacement", lab::kPlace);
    row.finish();
    if (path.size() < 2) continue;
    const Waypoint& before = path[path.size() - 2];
    if (next.time <= before.time) {
      row.fail("time", "is not after that of the row before", "give the rows in the order of time");
    }
    const double speed =
        (next.displacement - before.displacement).norm() / (next.time - before.time);
    if (!lab::kVelocity.contains(speed)) {
      row.fail("displacement", "is reached at " + number_text(speed) + " m/s",
               "give at most 1000 m/s from row to row");
    }
  }
  return path;
}

SceneryMotion read_motion(TomlTable table) {
  SceneryMotion motion;
  motion.velocity = read_vector(table, "velocity", lab::kVelocity);
  motion.angular_velocity = read_vector(table, "angular_velocity", lab::kAngularVelocity);
  motion.stroke = read_vector(table, "stroke", lab::kPlace);
  motion.frequency = table.number("frequency", between(0.0, 100.0), motion.frequency);
  motion.path = read_path(table);
  if (!motion.stroke.isZero(0.0) && motion.frequency == 0.0) {
    table.fail("stroke", "is given without a frequency", "give motion.frequency, above 0");
  }
  table.finish();
  return motion;
}

// Its surface is read with the models of the objects.
SceneryShape read_mesh(TomlTable table, std::filesystem::path& model) {
  model = table.path("model");
  table.finish();
  return MeshShape{};
}

}  // namespace

MeshShape read_mesh_shape(const std::filesystem::path& model) {
  if (!holds_rigid_body(hdf5::File::open(model))) {
    throw Error(model.string(), "is not of a rigid body, as scenery of a mesh is",
                "make its model with rigid = true in the configuration of irdm-precompute");
  }
  return {std::make_shared<const RestSurface>(read_model(model, ResponseKind::kModal).mesh)};
}

SceneryConfig read_scenery(TomlTable table, std::filesystem::path& model) {
  SceneryConfig scenery;
  scenery.name = read_name(table, scenery.name);
  const std::string shape = shape_of(table);
  if (shape == "plane") {
    scenery.shape = read_plane(table, table.table(shape), scenery.orientation);
  } else {
    scenery.orientation = read_orientation(table);
    if (shape == "box") scenery.shape = read_box(table.table(shape));
    if (shape == "sphere") scenery.shape = read_sphere(table.table(shape));
    if (shape == "capsule") scenery.shape = read_capsule(table.table(shape));
    if (shape == "mesh") scenery.shape = read_mesh(table.table(shape), model);
  }
  scenery.position = read_vector(table, "position", lab::kPlace);
  scenery.friction = read_friction(table.table("friction"), scenery.friction);
  scenery.motion = read_motion(table.table("motion"));
  table.finish();
  return scenery;
}

}  // namespace irdm
