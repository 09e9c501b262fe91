#include "tests/system/penetration.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "common/hdf5/file.hpp"
#include "common/model/model_file.hpp"

namespace irdm::test {
namespace {

using Corners = std::array<Vector3, 3>;

double to_segment(const Vector3& a, const Vector3& b, const Vector3& x) {
  const double along = std::clamp((x - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (x - a - along * (b - a)).norm();
}

double to_triangle(const Corners& t, const Vector3& x) {
  const Vector3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
  bool above = true;
  for (std::size_t i = 0; i < 3; ++i) {
    above = above && normal.cross(t[(i + 1) % 3] - t[i]).dot(x - t[i]) >= 0.0;
  }
  if (above) return std::abs(normal.normalized().dot(x - t[0]));
  return std::min(
      {to_segment(t[0], t[1], x), to_segment(t[1], t[2], x), to_segment(t[2], t[0], x)});
}

// Van Oosterom and Strackee 1983.
double solid_angle(const Corners& t, const Vector3& x) {
  const Vector3 a = t[0] - x;
  const Vector3 b = t[1] - x;
  const Vector3 c = t[2] - x;
  const double volume = a.dot(b.cross(c));
  const double rest = a.norm() * b.norm() * c.norm() + a.dot(b) * c.norm() + b.dot(c) * a.norm() +
                      c.dot(a) * b.norm();
  return 2.0 * std::atan2(volume, rest);
}

struct FromScenery {
  Vector3 x;  ///< in its frame

  double operator()(const PlaneShape& /*plane*/) const { return x.y(); }
  double operator()(const BoxShape& box) const {
    const Vector3 beyond = x.cwiseAbs() - 0.5 * box.size;
    return beyond.cwiseMax(0.0).norm() + std::min(0.0, beyond.maxCoeff());
  }
  double operator()(const SphereShape& sphere) const { return x.norm() - sphere.radius; }
  double operator()(const CapsuleShape& capsule) const {
    const double half = 0.5 * capsule.length;
    return to_segment({0, -half, 0}, {0, half, 0}, x) - capsule.radius;
  }
  double operator()(const MeshShape& /*mesh*/) const {
    throw std::runtime_error("no distance from scenery of a mesh");
  }
};

/// What a run file says of an object, and its triangles.
struct ObjectRun {
  std::vector<double> position, orientation, displacement, rest;
  Triangles triangles;

  std::size_t nodes() const { return rest.size() / 3; }
  std::vector<Vector3> places(std::size_t frame) const {
    const double* q = orientation.data() + 4 * frame;
    const Quaternion turn(q[0], q[1], q[2], q[3]);
    std::vector<Vector3> x(nodes());
    for (std::size_t i = 0; i < nodes(); ++i) {
      const Vector3 u(displacement.data() + 3 * (frame * nodes() + i));
      x[i] = Vector3(position.data() + 3 * frame) + turn * (Vector3(rest.data() + 3 * i) + u);
    }
    return x;
  }
};

ObjectRun read_object(const hdf5::File& file, std::size_t frames, std::size_t i,
                      const std::filesystem::path& model) {
  const std::string group = "/object/" + std::to_string(i) + "/";
  ObjectRun run;
  run.rest = file.read<double>(group + "rest", {0, 3});
  run.position = file.read<double>(group + "position", {frames, 3});
  run.orientation = file.read<double>(group + "orientation", {frames, 4});
  run.displacement = file.read<double>(group + "displacement", {frames, run.nodes(), 3});
  run.triangles = read_model(model, ResponseKind::kModal).mesh.triangles;
  return run;
}

std::vector<Corners> corners(const ObjectRun& object, const std::vector<Vector3>& places) {
  std::vector<Corners> all;
  for (Eigen::Index t = 0; t < object.triangles.rows(); ++t) {
    Corners& corner = all.emplace_back();
    for (Eigen::Index i = 0; i < 3; ++i) {
      corner[static_cast<std::size_t>(i)] =
          places[static_cast<std::size_t>(object.triangles(t, i))];
    }
  }
  return all;
}

/// Keeps the deepest of all nodes that it is told of.
struct Deepest {
  NodeInside found;

  void look(double distance, const NodeInside& node) {
    if (-distance <= found.depth) return;
    found = node;
    found.depth = -distance;
  }
};

void look_in_scenery(const SceneConfig& scene, const Vector3& x, NodeInside node,
                     Deepest& deepest) {
  for (const SceneryConfig& scenery : scene.scenery) {
    if (scenery.motion.any()) throw std::runtime_error("no distance from scenery that moves");
    node.other = scenery.name;
    const Vector3 there = scenery.orientation.conjugate() * (x - scenery.position);
    deepest.look(std::visit(FromScenery{there}, scenery.shape), node);
  }
  if (!scene.floor) return;
  node.other = "floor";
  deepest.look(scene.floor->normal.dot(x) - scene.floor->height, node);
}

}  // namespace

double signed_distance(const std::vector<std::array<Vector3, 3>>& triangles, const Vector3& x) {
  double nearest = std::numeric_limits<double>::infinity();
  double angle = 0.0;
  for (const Corners& triangle : triangles) {
    nearest = std::min(nearest, to_triangle(triangle, x));
    angle += solid_angle(triangle, x);
  }
  return angle > 2.0 * std::numbers::pi ? -nearest : nearest;
}

NodeInside deepest_inside(const std::filesystem::path& run, const SceneConfig& scene) {
  const hdf5::File file = hdf5::File::open(run);
  const std::vector<double> time = file.read<double>("/time", {0});
  std::vector<ObjectRun> objects;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    objects.push_back(read_object(file, time.size(), i, scene.objects[i].model));
  }
  Deepest deepest;
  for (std::size_t k = 0; k < time.size(); ++k) {
    std::vector<std::vector<Vector3>> places;
    std::vector<Eigen::AlignedBox3d> boxes;
    std::vector<std::vector<Corners>> triangles;
    for (const ObjectRun& object : objects) {
      places.push_back(object.places(k));
      Eigen::AlignedBox3d& box = boxes.emplace_back();
      for (const Vector3& x : places.back()) box.extend(x);
      triangles.push_back(corners(object, places.back()));
    }
    for (std::size_t i = 0; i < objects.size(); ++i) {
      for (std::size_t node = 0; node < places[i].size(); ++node) {
        const Vector3& x = places[i][node];
        NodeInside here{0.0, time[k], scene.objects[i].name, static_cast<int>(node), ""};
        look_in_scenery(scene, x, here, deepest);
        for (std::size_t other = 0; other < objects.size(); ++other) {
          if (other == i || !boxes[other].contains(x)) continue;
          here.other = scene.objects[other].name;
          deepest.look(signed_distance(triangles[other], x), here);
        }
      }
    }
  }
  return deepest.found;
}

}  // namespace irdm::test
