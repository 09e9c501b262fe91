// Shapes of static scenery against what is known of them otherwise: which points are inside, and
// samples of their surfaces.
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "simulation/collision/scenery.hpp"
#include "tests/simulation/random_numbers.hpp"
#include "tests/simulation/voxel_mesh.hpp"
#include "tests/support/allocation_guard.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/left_out.hpp"

using namespace irdm;
using namespace irdm::test;

namespace {

const Vector3 kBox(0.1, 0.16, 0.24);
constexpr double kSphere = 0.07;
constexpr CapsuleShape kCapsule{0.04, 0.12};
constexpr double kCell = 0.04;

// A cube of four cells an edge with a groove along z, two cells wide and deep, open at the top.
MeshShape grooved() {
  return {std::make_shared<const RestSurface>(voxel_surface(
      {4, 4, 4}, kCell,
      [](const std::array<int, 3>& cell) { return cell[0] < 1 || cell[0] > 2 || cell[1] < 2; }))};
}

const std::array<SceneryShape, 5> kShapes{PlaneShape{}, BoxShape{kBox}, SphereShape{kSphere},
                                          kCapsule, grooved()};

Vector3 random_direction(Random& random) {
  Vector3 way = anywhere(random, 1.0);
  while (way.norm() > 1 || way.norm() < 0.1) way = anywhere(random, 1.0);
  return way.normalized();
}

SceneryConfig posed(const SceneryShape& shape, Random& random) {
  SceneryConfig scenery;
  scenery.shape = shape;
  scenery.position = anywhere(random, 0.5);
  scenery.orientation =
      Eigen::AngleAxisd(between(random, 0.0, std::numbers::pi), random_direction(random));
  return scenery;
}

// By the definitions of the shapes: whether a point in a shape's frame is inside of it.
bool is_in(const PlaneShape& /*plane*/, const Vector3& p) {
  return p.y() < 0;
}
bool is_in(const BoxShape& box, const Vector3& p) {
  return (2.0 * p.cwiseAbs().array() < box.size.array()).all();
}
bool is_in(const SphereShape& sphere, const Vector3& p) {
  return p.norm() < sphere.radius;
}
bool is_in(const CapsuleShape& capsule, const Vector3& p) {
  const Vector3 end(0, 0.5 * capsule.length, 0);
  const bool cylinder =
      std::hypot(p.x(), p.z()) < capsule.radius && std::abs(p.y()) < 0.5 * capsule.length;
  return cylinder || (p - end).norm() < capsule.radius || (p + end).norm() < capsule.radius;
}

bool is_in(const MeshShape& /*grooved*/, const Vector3& p) {
  const bool groove = std::abs(p.x()) <= kCell && p.y() >= 0;
  return (p.cwiseAbs().array() < 2.0 * kCell).all() && !groove;
}

bool is_inside(const SceneryConfig& scenery, const Vector3& x) {
  const Vector3 p = scenery.orientation.conjugate() * (x - scenery.position);
  return std::visit([&](const auto& shape) { return is_in(shape, p); }, scenery.shape);
}

// Some point of a shape's surface, in its frame.
Vector3 sample(const PlaneShape& /*plane*/, Random& random) {
  return {between(random, -1, 1), 0.0, between(random, -1, 1)};
}
Vector3 sample(const BoxShape& box, Random& random) {
  Vector3 p = 0.5 * box.size.cwiseProduct(anywhere(random, 1.0));
  const int axis = static_cast<int>(random() % 3);
  p[axis] = std::copysign(0.5 * box.size[axis], p[axis]);
  return p;
}
Vector3 sample(const SphereShape& sphere, Random& random) {
  return sphere.radius * random_direction(random);
}
Vector3 sample(const CapsuleShape& capsule, Random& random) {
  const Vector3 way = random_direction(random);
  if (chance(random, 0.5)) {
    return capsule.radius * way + Vector3(0, std::copysign(0.5 * capsule.length, way.y()), 0);
  }
  const double angle = between(random, -std::numbers::pi, std::numbers::pi);
  const double y = 0.5 * between(random, -capsule.length, capsule.length);
  return {capsule.radius * std::cos(angle), y, capsule.radius * std::sin(angle)};
}

Vector3 sample(const MeshShape& mesh, Random& random) {
  const auto count = static_cast<unsigned>(mesh.surface->triangle_count());
  const TriangleCorners corners = mesh.surface->corners(static_cast<int>(random() % count));
  if (chance(random, 0.05)) return corners[0];
  const double a = std::sqrt(between(random, 0.0, 1.0));
  const double b = between(random, 0.0, 1.0);
  return (1 - a) * corners[0] + a * (1 - b) * corners[1] + a * b * corners[2];
}

Vector3 on_surface(const SceneryConfig& scenery, Random& random) {
  const Vector3 p =
      std::visit([&](const auto& shape) { return sample(shape, random); }, scenery.shape);
  return scenery.position + scenery.orientation * p;
}

}  // namespace

TEST_CASE("scenery: a hit is on the surface, its normal leads out and on to the query point") {
  Random random(1);
  for (const SceneryShape& shape : kShapes) {
    CAPTURE(shape.index());
    int within = 0;
    for (int n = 0; n < 3000; ++n) {
      const SceneryConfig scenery = posed(shape, random);
      const Vector3 x = scenery.position + anywhere(random, n % 2 == 0 ? 0.15 : 0.06);
      const SceneryHit hit = closest(scenery, x);
      REQUIRE(hit.normal.norm() == Approx(1.0).epsilon(1e-14));
      REQUIRE((hit.position + hit.signed_distance * hit.normal - x).norm() < 1e-14);
      REQUIRE((hit.signed_distance < 0) == is_inside(scenery, x));
      REQUIRE(is_inside(scenery, hit.position - 1e-12 * hit.normal));
      REQUIRE_FALSE(is_inside(scenery, hit.position + 1e-12 * hit.normal));
      within += hit.signed_distance < 0 ? 1 : 0;
    }
    CHECK(within > 500);
    CHECK(within < 2500);
  }
}

TEST_CASE("scenery: no sample of the surface is nearer than the hit, and one is nearly as near",
          "[slow]") {
  Random random(2);
  for (const SceneryShape& shape : kShapes) {
    CAPTURE(shape.index());
    const SceneryConfig scenery = posed(shape, random);
    std::vector<Vector3> samples(20'000);
    for (Vector3& each : samples) each = on_surface(scenery, random);
    for (int n = 0; n < 200; ++n) {
      const Vector3 x = scenery.position + anywhere(random, 0.15);
      const SceneryHit hit = closest(scenery, x);
      const double distance = std::abs(hit.signed_distance);
      double best = std::numeric_limits<double>::infinity();
      double beside = best;
      for (const Vector3& each : samples) {
        best = std::min(best, (each - x).norm());
        beside = std::min(beside, (each - hit.position).norm());
      }
      REQUIRE(best > distance - 1e-14);
      REQUIRE(beside < 0.05);
      REQUIRE(best <= distance + beside + 1e-14);
    }
  }
}

TEST_CASE("scenery: the normal is the gradient of the signed distance") {
  Random random(3);
  constexpr double kStep = 1e-6;
  for (const SceneryShape& shape : kShapes) {
    CAPTURE(shape.index());
    const SceneryConfig scenery = posed(shape, random);
    int smooth = 0;
    for (int n = 0; n < 1000; ++n) {
      const Vector3 x = scenery.position + anywhere(random, 0.12);
      const SceneryHit hit = closest(scenery, x);
      Vector3 gradient;
      double bend = 0.0;
      for (int i = 0; i < 3; ++i) {
        const Vector3 step = kStep * Vector3::Unit(i);
        const double above = closest(scenery, x + step).signed_distance;
        const double below = closest(scenery, x - step).signed_distance;
        gradient[i] = (above - below) / (2 * kStep);
        bend = std::max(bend, std::abs(above + below - 2 * hit.signed_distance) / kStep);
      }
      if (bend > 1e-3) continue;  // at the middle planes of a box, say
      ++smooth;
      REQUIRE((gradient - hit.normal).norm() < 1e-6);
    }
    CHECK(smooth > 990);
  }
}

TEST_CASE("scenery: ways enter where a march along them does", "[slow]") {
  constexpr int kSteps = 2000;
  Random random(4);
  for (const SceneryShape& shape : kShapes) {
    CAPTURE(shape.index());
    int entered = 0;
    int missed = 0;
    int grazed = 0;
    for (int n = 0; n < 1500; ++n) {
      const SceneryConfig scenery = posed(shape, random);
      const Vector3 from = scenery.position + anywhere(random, 0.25);
      const Vector3 to = scenery.position + anywhere(random, 0.25);
      const auto hit = first_crossing(scenery, from, to);
      if (is_inside(scenery, from)) {
        REQUIRE_FALSE(hit);
        continue;
      }
      const double length = (to - from).norm();
      int first = 0;
      while (first <= kSteps && !is_inside(scenery, from + first * (to - from) / kSteps)) ++first;
      if (!hit) {
        REQUIRE(first > kSteps);
        ++missed;
        continue;
      }
      const double along = (hit->position - from).dot(to - from) / length;
      REQUIRE((from + along / length * (to - from) - hit->position).norm() < 1e-14);
      REQUIRE(hit->normal.norm() == Approx(1.0).epsilon(1e-14));
      REQUIRE(hit->normal.dot(to - from) < 0);
      REQUIRE(hit->signed_distance == 0.0);
      REQUIRE(std::abs(closest(scenery, hit->position).signed_distance) < 1e-14);
      if (first > kSteps) {  // in and out between two steps
        ++grazed;
        continue;
      }
      REQUIRE(along < length * first / kSteps + 1e-14);
      REQUIRE(along > length * (first - 1) / kSteps - 1e-14);
      ++entered;
    }
    CHECK(entered > 100);
    CHECK(missed > 200);
    CHECK(grazed < 5);
  }
}

TEST_CASE("scenery: what only touches does not enter, what starts or ends on the surface may") {
  const auto crossing = [](const SceneryShape& shape, const Vector3& from, const Vector3& to) {
    return first_crossing({"", shape}, from, to);
  };
  const double x = 0.5 * kBox.x();
  const double y = 0.5 * kBox.y();
  // Along a surface, over an edge, away, and no way at all.
  CHECK_FALSE(crossing(PlaneShape{}, {0, 0, 0}, {1, 0, 0}));
  CHECK_FALSE(crossing(PlaneShape{}, {0, 0, 0}, {0, 1, 0}));
  CHECK_FALSE(crossing(PlaneShape{}, {0, -1, 0}, {0, -2, 0}));
  CHECK_FALSE(crossing(BoxShape{kBox}, {x, 1, 0}, {x, -1, 0}));
  CHECK_FALSE(crossing(BoxShape{kBox}, {x - 1, y + 1, 0}, {x + 1, y - 1, 0}));
  CHECK_FALSE(crossing(BoxShape{kBox}, {x, 0, 0}, {1, 0, 0}));
  CHECK_FALSE(crossing(SphereShape{kSphere}, {kSphere, -1, 0}, {kSphere, 1, 0}));
  CHECK_FALSE(crossing(SphereShape{kSphere}, {kSphere, 0, 0}, {1, 0, 0}));
  CHECK_FALSE(crossing(kCapsule, {kCapsule.radius, -1, 0}, {kCapsule.radius, 1, 0}));
  for (const SceneryShape& shape : kShapes) CHECK_FALSE(crossing(shape, {1, 1, 1}, {1, 1, 1}));
  // From the surface inwards, and up to it.
  for (const double end : {-1.0, 0.0}) {
    const auto plane = crossing(PlaneShape{}, {2, 1 + end, 3}, {2, end, 3});
    REQUIRE(plane);
    CHECK(plane->position == Vector3(2, 0, 3));
  }
  for (const auto& [from, to] : {std::pair(x, 0.0), std::pair(1.0, x)}) {
    const auto box = crossing(BoxShape{kBox}, {from, 0.01, 0.02}, {to, 0.01, 0.02});
    REQUIRE(box);
    CHECK((box->position - Vector3(x, 0.01, 0.02)).norm() < 1e-16);
    CHECK(box->normal == Vector3(1, 0, 0));
  }
  for (const auto& [from, to] : {std::pair(kSphere, 0.0), std::pair(1.0, kSphere - 1e-15)}) {
    const auto sphere = crossing(SphereShape{kSphere}, {0, from, 0}, {0, to, 0});
    REQUIRE(sphere);
    CHECK((sphere->position - Vector3(0, kSphere, 0)).norm() < 1e-15);
    CHECK(sphere->normal == Vector3(0, 1, 0));
  }
  // Through an edge of a box exactly: one of its faces.
  const auto edge = crossing(BoxShape{kBox}, {x + 1, y + 1, 0}, {x - 1, y - 1, 0});
  REQUIRE(edge);
  CHECK((edge->position - Vector3(x, y, 0)).norm() < 1e-15);
  CHECK(edge->normal.sum() == 1.0);
}

TEST_CASE("scenery: a way through a capsule enters by its side or by one of its ends") {
  const SceneryConfig capsule{"", kCapsule};
  const double end = 0.5 * kCapsule.length + kCapsule.radius;
  const auto side = first_crossing(capsule, {0, 0.03, -1}, {0, 0.03, 1});
  REQUIRE(side);
  CHECK((side->position - Vector3(0, 0.03, -kCapsule.radius)).norm() < 1e-15);
  CHECK((side->normal - Vector3(0, 0, -1)).norm() < 1e-15);
  for (const double way : {-1.0, 1.0}) {
    const auto cap = first_crossing(capsule, {0, -way, 0}, {0, way, 0});
    REQUIRE(cap);
    CHECK((cap->position - Vector3(0, -way * end, 0)).norm() < 1e-15);
    CHECK((cap->normal - Vector3(0, -way, 0)).norm() < 1e-15);
  }
}

TEST_CASE("scenery: a small one is met from afar") {
  SceneryConfig sphere{"", SphereShape{1e-6}};
  sphere.position = Vector3(1, 2, 3);
  const Vector3 from(5000, -3000, 4000);
  const Vector3 way = sphere.position - from;
  const Vector3 aside = way.cross(Vector3::UnitY()).normalized();
  CHECK(first_crossing(sphere, from + 9e-7 * aside, from + 9e-7 * aside + 2 * way));
  CHECK_FALSE(first_crossing(sphere, from + 1.1e-6 * aside, from + 1.1e-6 * aside + 2 * way));
}

TEST_CASE("scenery: where several points are nearest, one of them is given") {
  const auto on_axis = [](const SceneryShape& shape, const Vector3& x) {
    const SceneryHit hit = closest({"", shape}, x);
    CHECK(hit.normal.norm() == Approx(1.0).epsilon(1e-15));
    CHECK((hit.position + hit.signed_distance * hit.normal - x).norm() < 1e-15);
    return hit;
  };
  for (const double off : {0.0, 1e-310, 1e-160, 1e-80}) {
    CHECK(on_axis(SphereShape{kSphere}, {0, off, 0}).signed_distance == -kSphere);
    for (const double y : {-0.06, 0.0, 0.02, 0.06}) {
      CHECK(on_axis(kCapsule, {off, y, 0}).signed_distance == -kCapsule.radius);
    }
    const SceneryHit box = on_axis(BoxShape{kBox}, {0, off, 0});
    CHECK(box.signed_distance == -0.5 * kBox.x());
    CHECK(std::abs(box.position.x()) == 0.5 * kBox.x());
  }
  // At a corner, and on an edge.
  CHECK(on_axis(BoxShape{kBox}, 0.5 * kBox).signed_distance == 0.0);
  CHECK(on_axis(BoxShape{kBox}, {0.5 * kBox.x(), 0, 0.5 * kBox.z()}).signed_distance == 0.0);
  // The middle planes of a cube, all at once.
  CHECK(on_axis(BoxShape{Vector3::Constant(0.2)}, Vector3::Zero()).signed_distance == -0.1);
}

TEST_CASE("scenery: mirrored queries give mirrored hits") {
  Random random(5);
  for (const SceneryShape& shape : kShapes) {
    if (std::holds_alternative<MeshShape>(shape)) continue;  // its triangles are not symmetric
    const SceneryConfig scenery{"", shape};
    for (int n = 0; n < 300; ++n) {
      const Vector3 from = anywhere(random, 0.2);
      const Vector3 to = anywhere(random, 0.2);
      Vector3 mirror(-1, -1, -1);
      if (std::holds_alternative<PlaneShape>(shape)) mirror.y() = 1;
      const auto mirrored = [&](const Vector3& x) -> Vector3 { return mirror.cwiseProduct(x); };
      const SceneryHit hit = closest(scenery, from);
      const SceneryHit other = closest(scenery, mirrored(from));
      REQUIRE(other.position == mirrored(hit.position));
      REQUIRE(other.normal == mirrored(hit.normal));
      REQUIRE(other.signed_distance == hit.signed_distance);
      const auto in = first_crossing(scenery, from, to);
      const auto other_in = first_crossing(scenery, mirrored(from), mirrored(to));
      REQUIRE(in.has_value() == other_in.has_value());
      if (in) REQUIRE((other_in->position - mirrored(in->position)).norm() < 1e-15);
    }
  }
}

TEST_CASE("scenery: all of its surface is within its bounding radius, and some of it is there") {
  Random random(6);
  CHECK(std::isinf(bounding_radius(PlaneShape{})));
  for (std::size_t i = 1; i < kShapes.size(); ++i) {
    const SceneryConfig scenery = posed(kShapes[i], random);
    const double radius = bounding_radius(scenery.shape);
    double farthest = 0.0;
    for (int n = 0; n < 20'000; ++n) {
      farthest = std::max(farthest, (on_surface(scenery, random) - scenery.position).norm());
    }
    CAPTURE(i, radius);
    CHECK(farthest <= radius + 1e-15);
    CHECK(farthest > 0.99 * radius);
  }
}

TEST_CASE("scenery: queries do not allocate") {
  if (!AllocationGuard::active()) return leave_out(kNotCounted);
  Random random(7);
  std::array<SceneryConfig, kShapes.size()> sceneries;
  for (std::size_t i = 0; i < kShapes.size(); ++i) sceneries[i] = posed(kShapes[i], random);
  double sum = 0.0;
  const AllocationGuard guard;
  for (const SceneryConfig& scenery : sceneries) {
    for (int n = 0; n < 100; ++n) {
      const Vector3 x = anywhere(random, 1.0);
      sum += closest(scenery, x).signed_distance;
      sum += first_crossing(scenery, x, -x) ? 1.0 : 0.0;
    }
  }
  CHECK(guard.count() == 0);
  CHECK(std::isfinite(sum));
}
