#include "simulation/collision/scenery.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "common/motion/rigid_body.hpp"

namespace irdm {
namespace {

// A way [m] as short as this has no direction: its square is no longer exact.
constexpr double kNoLength = 1e-100;
// Nearer than this to a mesh [m] is on it: what rounding makes of a point of its surface.
constexpr double kOnMesh = 1e-12;

// Points and hits are in the frame of the shape, up to to_shape().

SceneryHit nearest(const PlaneShape& /*plane*/, const Vector3& p) noexcept {
  return {{p.x(), 0.0, p.z()}, Vector3::UnitY(), p.y()};
}

SceneryHit nearest(const BoxShape& box, const Vector3& p) noexcept {
  const Vector3 half = 0.5 * box.size;
  Vector3 point = p.cwiseMin(half).cwiseMax(-half);
  const Vector3 away = p - point;
  const double outside = away.norm();
  if (outside > kNoLength) return {point, away / outside, outside};
  Eigen::Index axis = 0;
  const double depth = (half - p.cwiseAbs()).minCoeff(&axis);
  const Vector3 normal = std::copysign(1.0, p[axis]) * Vector3::Unit(axis);
  point[axis] = normal[axis] * half[axis];
  return {point, normal, -depth};
}

SceneryHit nearest(const CapsuleShape& capsule, const Vector3& p) noexcept {
  const double half = 0.5 * capsule.length;
  const Vector3 core(0.0, std::clamp(p.y(), -half, half), 0.0);
  const Vector3 away = p - core;
  const double distance = away.norm();
  const Vector3 normal = distance > kNoLength ? Vector3(away / distance) : Vector3::UnitX();
  return {core + capsule.radius * normal, normal, distance - capsule.radius};
}

SceneryHit nearest(const SphereShape& sphere, const Vector3& p) noexcept {
  return nearest(CapsuleShape{sphere.radius, 0.0}, p);
}

// Of the face, edge or corner that a point lies on; its sign tells inside from outside.
Vector3 pseudonormal(const RestSurface& surface, const SurfaceLocation& at) noexcept {
  const Barycentric& weights = at.point.weights;
  const auto corners =
      std::count_if(weights.begin(), weights.end(), [](double w) { return w > 0; });
  if (corners == 1) return surface.smooth_normal(at.point);
  const RestSurface::Plane& plane = surface.plane(at.triangle);
  if (corners == 3) return plane.normal;
  const auto far = std::find(weights.begin(), weights.end(), 0.0) - weights.begin();
  const int beyond = plane.across[static_cast<std::size_t>(far)];
  return (plane.normal + surface.plane(beyond).normal).normalized();
}

SceneryHit nearest(const MeshShape& mesh, const Vector3& p) noexcept {
  const SurfaceLocation at = mesh.surface->closest(p);
  const Vector3 outward = pseudonormal(*mesh.surface, at);
  const Vector3 away = p - at.position;
  const double distance = away.norm();
  if (distance < kOnMesh) return {at.position, outward, away.dot(outward)};
  const double side = std::copysign(1.0, away.dot(outward));
  return {at.position, side / distance * away, side * distance};
}

std::optional<SceneryHit> crossing(const PlaneShape& /*plane*/, const Vector3& from,
                                   const Vector3& to) noexcept {
  if (from.y() < 0 || to.y() > 0 || !(to.y() < from.y())) return std::nullopt;
  const Vector3 point = from + from.y() / (from.y() - to.y()) * (to - from);
  return SceneryHit{{point.x(), 0.0, point.z()}, Vector3::UnitY(), 0.0};
}

// A box is what three slabs have in common: the way is in it from where it enters the last of them
// to where it leaves the first.
std::optional<SceneryHit> crossing(const BoxShape& box, const Vector3& from,
                                   const Vector3& to) noexcept {
  const Vector3 half = 0.5 * box.size;
  const Vector3 way = to - from;
  double enters = -std::numeric_limits<double>::infinity();
  double leaves = std::numeric_limits<double>::infinity();
  Eigen::Index face = 0;
  for (Eigen::Index i = 0; i < 3; ++i) {
    if (way[i] == 0) {
      if (std::abs(from[i]) >= half[i]) return std::nullopt;
      continue;
    }
    const double far = std::copysign(half[i], way[i]);
    const double in = (-far - from[i]) / way[i];
    if (in > enters) {
      enters = in;
      face = i;
    }
    leaves = std::min(leaves, (far - from[i]) / way[i]);
  }
  if (!(enters >= 0 && enters <= 1 && enters < leaves)) return std::nullopt;
  const Vector3 normal = std::copysign(1.0, -way[face]) * Vector3::Unit(face);
  Vector3 point = (from + enters * way).cwiseMin(half).cwiseMax(-half);
  point[face] = normal[face] * half[face];
  return SceneryHit{point, normal, 0.0};
}

// Fraction of a way from outside at which it enters a ball about the origin; infinite if it does
// not. From the point of the way's line that is nearest to the centre, which is as exact as the
// start is, however distant.
double entry(const Vector3& from, const Vector3& way, double radius) noexcept {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const double approach = -from.dot(way);
  if (!(approach > 0)) return kNever;
  const double middle = approach / way.squaredNorm();
  const double half_chord2 = radius * radius - (from + middle * way).squaredNorm();
  if (!(half_chord2 > 0)) return kNever;
  return std::max(0.0, middle - std::sqrt(half_chord2) / way.norm());
}

// The first of its parts is entered: the cylinder by its side, or one of the two balls.
std::optional<SceneryHit> crossing(const CapsuleShape& capsule, const Vector3& from,
                                   const Vector3& to) noexcept {
  if (nearest(capsule, from).signed_distance < 0) return std::nullopt;
  const Vector3 way = to - from;
  const double half = 0.5 * capsule.length;
  double first = 2.0;  // beyond the end of the way
  for (const double end : {-half, half}) {
    first = std::min(first, entry(from - Vector3(0.0, end, 0.0), way, capsule.radius));
  }
  const Vector3 across(1.0, 0.0, 1.0);
  const double side = entry(from.cwiseProduct(across), way.cwiseProduct(across), capsule.radius);
  if (side < first && std::abs(from.y() + side * way.y()) <= half) first = side;
  if (first > 1) return std::nullopt;
  SceneryHit hit = nearest(capsule, from + first * way);
  hit.signed_distance = 0.0;
  return hit;
}

std::optional<SceneryHit> crossing(const SphereShape& sphere, const Vector3& from,
                                   const Vector3& to) noexcept {
  return crossing(CapsuleShape{sphere.radius, 0.0}, from, to);
}

std::optional<SceneryHit> crossing(const MeshShape& mesh, const Vector3& from,
                                   const Vector3& to) noexcept {
  const std::optional<SurfaceTree::Entry> entry = mesh.surface->tree().first_entry(from, to);
  if (!entry || nearest(mesh, from).signed_distance < -kOnMesh) return std::nullopt;
  return SceneryHit{from + entry->fraction * (to - from),
                    mesh.surface->plane(entry->triangle).normal, 0.0};
}

double radius_of(const PlaneShape& /*plane*/) noexcept {
  return std::numeric_limits<double>::infinity();
}
double radius_of(const BoxShape& box) noexcept {
  return 0.5 * box.size.norm();
}
double radius_of(const SphereShape& sphere) noexcept {
  return sphere.radius;
}
double radius_of(const CapsuleShape& capsule) noexcept {
  return capsule.radius + 0.5 * capsule.length;
}

double radius_of(const MeshShape& mesh) noexcept {
  double largest = 0.0;
  for (int i = 0; i < mesh.surface->node_count(); ++i) {
    largest = std::max(largest, mesh.surface->node(i).norm());
  }
  return largest;
}

Vector3 to_shape(const SceneryConfig& scenery, const Vector3& x) noexcept {
  return scenery.orientation.conjugate() * (x - scenery.position);
}

SceneryHit to_world(const SceneryConfig& scenery, const SceneryHit& hit) noexcept {
  return {scenery.position + scenery.orientation * hit.position,
          (scenery.orientation * hit.normal).normalized(), hit.signed_distance};
}

}  // namespace

SceneryHit closest(const SceneryConfig& scenery, const Vector3& x) noexcept {
  const Vector3 p = to_shape(scenery, x);
  return to_world(scenery,
                  std::visit([&](const auto& shape) { return nearest(shape, p); }, scenery.shape));
}

std::optional<SceneryHit> first_crossing(const SceneryConfig& scenery, const Vector3& from,
                                         const Vector3& to) noexcept {
  const Vector3 begin = to_shape(scenery, from);
  const Vector3 end = to_shape(scenery, to);
  const std::optional<SceneryHit> hit =
      std::visit([&](const auto& shape) { return crossing(shape, begin, end); }, scenery.shape);
  if (!hit) return std::nullopt;
  return to_world(scenery, *hit);
}

namespace {

Vector3 displacement(const std::vector<Waypoint>& path, double t) noexcept {
  if (path.empty()) return Vector3::Zero();
  const auto next = std::upper_bound(
      path.begin(), path.end(), t, [](double time, const Waypoint& at) { return time < at.time; });
  if (next == path.begin()) return next->displacement;
  const auto last = next - 1;
  if (next == path.end()) return last->displacement;
  const double share = (t - last->time) / (next->time - last->time);
  return last->displacement + share * (next->displacement - last->displacement);
}

}  // namespace

void SceneryStep::go_on(double t) noexcept {
  const SceneryMotion& motion = now.motion;
  const double phase = 2.0 * std::numbers::pi * motion.frequency * t;
  const Quaternion orientation =
      (rotation_from_vector(t * motion.angular_velocity) * first_orientation).normalized();
  const Vector3 position = first_position + t * motion.velocity +
                           0.5 * (1.0 - std::cos(phase)) * motion.stroke +
                           displacement(motion.path, t);
  before = origin = t > 0 ? now.position : position;
  turn = t > 0 ? Quaternion(orientation * now.orientation.conjugate()) : Quaternion::Identity();
  now.position = position;
  now.orientation = orientation;
}

double bounding_radius(const SceneryShape& shape) noexcept {
  return std::visit([](const auto& each) { return radius_of(each); }, shape);
}

}  // namespace irdm
