#include "simulation/collision/deformed_surface.hpp"

#include <algorithm>
#include <cmath>
#include "simulation/state/state_archive.hpp"

namespace irdm {
namespace {
// Enough to cross a dozen triangles from a good start, and a bound on the cost of a bad one.
constexpr int kMaxSlides = 16;
// Triangles in a box that are looked at.
constexpr std::size_t kMaxCandidates = 256;
// Sum of changes beyond which nothing is known of nodes from before; below it the sum is exact to
// much less than kSlack [m], which is also more than kSeam of a triangle.
constexpr double kLargestChange = 1.0;
constexpr double kSlack = 1e-9;
// Barycentric weights by which triangles of a set overlap: nodes that mirror each other meet
// exactly, and a way through a node may miss all triangles by rounding.
constexpr double kSeam = 1e-9;

bool has(TriangleSet among, int triangle) noexcept {
  return among.empty() || among[static_cast<std::size_t>(triangle)] != 0;
}
}  // namespace

DeformedSurface::DeformedSurface(const RestSurface& rest)
    : rest_(rest),
      known_in_(static_cast<std::size_t>(rest.node_count()), 0),
      change_then_(static_cast<std::size_t>(rest.node_count()), 0.0),
      seen_in_(static_cast<std::size_t>(rest.node_count()), 0),
      positions_(static_cast<std::size_t>(rest.node_count()), Vector3::Zero()) {
  seen_.reserve(positions_.size());
  for (int i = 0; i < rest.node_count(); ++i) rest_box_.extend(rest.node(i));
}

void DeformedSurface::begin_step(const ResponseEngine& engine, double change) noexcept {
  engine_ = &engine;
  ++step_;
  seen_.clear();
  if (change == 0.0) return;
  ++state_;
  queried_ = false;
  change_ += change;
  if (change_ < kLargestChange) return;
  bounded_since_ = state_;
  change_ = 0.0;
}

void DeformedSurface::archive(StateArchive& state, const ResponseEngine& engine) {
  if (state.reading()) engine_ = &engine;
  for (std::uint64_t* number : {&state_, &step_, &bounded_since_, &bound_known_in_}) {
    state.value(*number);
  }
  state.value(queried_);
  state.value(change_);
  state.value(bound_);
  state.values(known_in_);
  state.values(change_then_);
  state.values(seen_in_);
  state.values(positions_);
  state.list(seen_);
}

void DeformedSurface::mark_seen(std::size_t node) noexcept {
  if (seen_in_[node] == step_) return;
  seen_in_[node] = step_;
  seen_.push_back(static_cast<int>(node));
  queried_ = true;
}

const Vector3& DeformedSurface::node(int i) noexcept {
  const auto index = static_cast<std::size_t>(i);
  if (known_in_[index] != state_) {
    positions_[index] = rest_.node(i) + engine_->free_displacement(i);
    known_in_[index] = state_;
    change_then_[index] = change_;
  }
  mark_seen(index);
  return positions_[index];
}

// The corners of a triangle as they were computed last, and by how much they have moved since at
// most [m]; none: that is not known.
std::optional<double> DeformedSurface::known(int triangle, TriangleCorners& then) noexcept {
  constexpr double kRounding = 1e-9;
  double change = 0.0;
  const std::array<int, 3>& nodes = rest_.topology().corners(triangle);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto index = static_cast<std::size_t>(nodes[i]);
    if (known_in_[index] < bounded_since_) return std::nullopt;
    then[i] = positions_[index];
    change = std::max(change, change_ - change_then_[index]);
  }
  for (const int node : nodes) mark_seen(static_cast<std::size_t>(node));
  return (1.0 + kRounding) * std::sqrt(3.0) * change + kSlack;
}

// Whether a triangle is farther from a point, by what is known without computing a node.
bool DeformedSurface::is_beyond(double distance, int triangle, const Vector3& p) noexcept {
  constexpr double kRounding = 1e-9;
  TriangleCorners then;
  const std::optional<double> moved = known(triangle, then);
  if (!moved) return false;
  const double limit = (distance + *moved) / (1.0 - kRounding);
  const double limit2 = limit * limit;
  return least_distance2(then, p) > limit2 ||
         (p - at(then, closest_point(then, p))).squaredNorm() > limit2;
}

// Whether a triangle has no part in a box, by what is known without computing a node.
bool DeformedSurface::is_outside(const Eigen::AlignedBox3d& box, int triangle) noexcept {
  TriangleCorners then;
  const std::optional<double> moved = known(triangle, then);
  if (!moved) return false;
  Eigen::AlignedBox3d bounds(then[0]);
  bounds.extend(then[1]).extend(then[2]);
  const Vector3 margin = Vector3::Constant(*moved);
  return !box.intersects({bounds.min() - margin, bounds.max() + margin});
}

TriangleCorners DeformedSurface::corners(int triangle) noexcept {
  const std::array<int, 3>& nodes = rest_.topology().corners(triangle);
  return {node(nodes[0]), node(nodes[1]), node(nodes[2])};
}

Vector3 DeformedSurface::normal(int triangle) noexcept {
  return area_normal(corners(triangle)).normalized();
}

SurfaceHit DeformedSurface::hit_on(int triangle, const Vector3& p) noexcept {
  const TriangleCorners deformed = corners(triangle);
  SurfaceHit hit;
  hit.triangle = triangle;
  hit.point = {rest_.topology().corners(triangle), closest_point(deformed, p)};
  hit.position = at(deformed, hit.point.weights);
  hit.signed_distance = (p - hit.position).norm();
  return hit;
}

template <typename Visit>
void DeformedSurface::visit_neighbours(int triangle, const Visit& visit) noexcept {
  for (const int corner : rest_.topology().corners(triangle)) {
    for (const int neighbour : rest_.topology().triangles_around(corner)) {
      if (neighbour != triangle) visit(neighbour);
    }
  }
}

// Triangles around `near`, and those in a box. False: there are more of these. The tree knows the
// rest shape: the box is moved to where it would be there.
template <typename Visit>
bool DeformedSurface::visit_about(Eigen::AlignedBox3d box, const SurfaceHit& near,
                                  const Visit& visit) noexcept {
  visit(near.triangle);
  visit_neighbours(near.triangle, visit);
  const Vector3 u =
      interpolate(near.point, [&](int i) -> Vector3 { return node(i) - rest_.node(i); });
  const Vector3 margin = Vector3::Constant(0.25 * u.norm());
  std::array<int, kMaxCandidates> candidates;
  const int count =
      rest_.tree().overlapping({box.min() - u - margin, box.max() - u + margin}, candidates);
  for (int i = 0; i < count; ++i) visit(candidates[static_cast<std::size_t>(i)]);
  return count < static_cast<int>(kMaxCandidates);
}

SurfaceHit DeformedSurface::descend(SurfaceHit best, const Vector3& p, TriangleSet among) noexcept {
  for (int move = 0; move < kMaxSlides; ++move) {
    const int here = best.triangle;
    visit_neighbours(here, [&](int neighbour) {
      if (!has(among, neighbour)) return;
      if (is_beyond(best.signed_distance, neighbour, p)) return;
      const SurfaceHit hit = hit_on(neighbour, p);
      if (hit.signed_distance < best.signed_distance) best = hit;
    });
    if (best.triangle == here) break;
  }
  return best;
}

// Normal of the feature (face, edge or corner) that the nearest point lies on. Weighting the faces
// round a corner by their angle makes its sign the right one for inside and outside.
Vector3 DeformedSurface::pseudonormal(const SurfaceHit& hit) noexcept {
  std::array<int, 3> on{};  // nodes of the feature: 1 corner, 2 edge, 3 face
  std::size_t count = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    if (hit.point.weights[i] > 0) on[count++] = hit.point.nodes[i];
  }
  if (count == 3) return normal(hit.triangle);
  Vector3 sum = Vector3::Zero();
  for (const int triangle : rest_.topology().triangles_around(on[0])) {
    const std::array<int, 3>& nodes = rest_.topology().corners(triangle);
    const TriangleCorners deformed = corners(triangle);
    const Vector3 unit = area_normal(deformed).normalized();
    if (count == 2) {
      if (std::find(nodes.begin(), nodes.end(), on[1]) != nodes.end()) sum += unit;
      continue;
    }
    const auto corner =
        static_cast<std::size_t>(std::find(nodes.begin(), nodes.end(), on[0]) - nodes.begin());
    const Vector3 a = deformed[(corner + 1) % 3] - deformed[corner];
    const Vector3 b = deformed[(corner + 2) % 3] - deformed[corner];
    sum += std::atan2(a.cross(b).norm(), a.dot(b)) * unit;
  }
  return sum;
}

// A little more, so that no rounding makes it less.
double DeformedSurface::bound() noexcept {
  if (bound_known_in_ != state_) bound_ = (1.0 + 1e-9) * engine_->free_displacement_bound();
  bound_known_in_ = state_;
  return bound_;
}

bool DeformedSurface::is_far_from(const Vector3& from, const Vector3& to) noexcept {
  Eigen::AlignedBox3d way(from);
  way.extend(to);
  if (way.intersects(rest_box_)) return false;
  const Vector3 margin = Vector3::Constant(bound());
  return !way.intersects(Eigen::AlignedBox3d(rest_box_.min() - margin, rest_box_.max() + margin));
}

SurfaceHit DeformedSurface::closest(const Vector3& p) noexcept {
  SurfaceHit best = hit_on(rest_.tree().closest_triangle(p), p);
  // Where the surface is displaced by u, the rest surface below p - u is the better place to start.
  const Vector3 u =
      interpolate(best.point, [&](int i) -> Vector3 { return node(i) - rest_.node(i); });
  const SurfaceHit shifted = hit_on(rest_.tree().closest_triangle(p - u), p);
  if (shifted.signed_distance < best.signed_distance) best = shifted;
  best = descend(best, p);
  if (pseudonormal(best).dot(p - best.position) < 0) best.signed_distance = -best.signed_distance;
  return best;
}

SurfaceHit DeformedSurface::closest_from(int triangle, const Vector3& p,
                                         TriangleSet among) noexcept {
  return descend(hit_on(triangle, p), p, among);
}

std::optional<SurfaceHit> DeformedSurface::first_crossing(const Vector3& from, const Vector3& to,
                                                          const SurfaceHit& near,
                                                          TriangleSet among) noexcept {
  std::optional<SurfaceHit> found;
  double earliest = 2.0;
  Eigen::AlignedBox3d way(from);
  way.extend(to);
  const auto consider = [&](int candidate) {
    if (!has(among, candidate) || is_outside(way, candidate)) return;
    const TriangleCorners deformed = corners(candidate);
    std::optional<Crossing> here = crossing(deformed, from, to, among.empty() ? 0.0 : kSeam);
    if (!here || here->fraction >= earliest) return;
    earliest = here->fraction;
    for (double& weight : here->weights) weight = std::max(0.0, weight);
    const SurfacePoint point{rest_.topology().corners(candidate), here->weights};
    found = SurfaceHit{candidate, point, at(deformed, here->weights), 0.0};
  };
  visit_about(way, near, consider);
  return found;
}

double DeformedSurface::distance_up_to(double limit, const Vector3& p,
                                       const SurfaceHit& near) noexcept {
  double nearest = limit;
  const auto consider = [&](int triangle) {
    if (is_beyond(nearest, triangle, p)) return;
    nearest = std::min(nearest, hit_on(triangle, p).signed_distance);
  };
  const Vector3 reach = Vector3::Constant(limit);
  return visit_about({p - reach, p + reach}, near, consider) ? nearest : 0.0;
}

}  // namespace irdm
