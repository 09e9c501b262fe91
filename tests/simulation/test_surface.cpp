#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "simulation/collision/deformed_surface.hpp"
#include "simulation/step/god_object.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/synthetic_model.hpp"

using namespace irdm;

namespace {

// Displaces every node of a mesh as a function of its rest position says.
class FakeEngine final : public ResponseEngine {
 public:
  template <typename Field>
  FakeEngine(const ModelMesh& mesh, const Field& field) {
    for (int i = 0; i < mesh.surface_node_count(); ++i) u_.push_back(field(mesh.rest_position(i)));
  }
  Vector3 free_displacement(int node) const noexcept override {
    ++evaluations;
    return u_[static_cast<std::size_t>(node)];
  }
  double free_displacement_bound() const noexcept override { return bound; }
  void predict(std::span<const ContactPatch>, std::span<Vector3>,
               ContactMatrix&) noexcept override {}
  void predict_horizon(const ContactPatch&, std::span<const NodalForce>, std::span<Vector3>,
                       std::span<Matrix3>) noexcept override {}
  void cross_response(const ContactPatch&, const ContactPatch&,
                      std::span<Matrix3>) noexcept override {}
  void add_delayed_force(std::span<const NodalForce>, int) noexcept override {}
  void advance(std::span<const NodalForce>) noexcept override {}
  void displacement(Points&, double) const override {}
  void reset() noexcept override {}
  void archive(StateArchive& /*state*/) override {}
  void move(const std::vector<Vector3>& by) {
    for (std::size_t i = 0; i < u_.size(); ++i) u_[i] += by[i];
  }
  mutable int evaluations = 0;
  double bound = std::numeric_limits<double>::infinity();

 private:
  std::vector<Vector3> u_;
};

Vector3 random_point(std::mt19937& random, double reach) {
  std::uniform_real_distribution<double> uniform(-reach, reach);
  return {uniform(random), uniform(random), uniform(random)};
}

// Signed distance to an axis-aligned cube of half edge a, positive outside.
double cube_distance(const Vector3& p, double a) {
  const Vector3 d = p.cwiseAbs() - Vector3::Constant(a);
  return d.cwiseMax(0.0).norm() + std::min(d.maxCoeff(), 0.0);
}

}  // namespace

TEST_CASE("nearest point of a triangle: face, edges and corners") {
  const TriangleCorners triangle{Vector3(0, 0, 0), Vector3(2, 0, 0), Vector3(0, 2, 0)};
  CHECK((at(triangle, closest_point(triangle, {0.5, 0.5, 3})) - Vector3(0.5, 0.5, 0)).norm() <
        1e-15);
  CHECK((at(triangle, closest_point(triangle, {1, -5, 1})) - Vector3(1, 0, 0)).norm() < 1e-15);
  CHECK((at(triangle, closest_point(triangle, {2, 2, -1})) - Vector3(1, 1, 0)).norm() < 1e-15);
  CHECK(closest_point(triangle, {-1, -1, 0}) == Barycentric{1, 0, 0});
  CHECK(closest_point(triangle, {5, -1, 0}) == Barycentric{0, 1, 0});
  const TriangleCorners line{Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(2, 0, 0)};
  CHECK((at(line, closest_point(line, {1.5, 1, 0})) - Vector3(1.5, 0, 0)).norm() < 1e-15);
}

TEST_CASE("nearest point of a triangle is never beaten by a sample of it") {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int i = 0; i < 300; ++i) {
    const TriangleCorners triangle{random_point(random, 1), random_point(random, 1),
                                   random_point(random, 1)};
    const Vector3 p = random_point(random, 2);
    const Barycentric weights = closest_point(triangle, p);
    REQUIRE(weights[0] + weights[1] + weights[2] == Approx(1.0));
    const double distance = (at(triangle, weights) - p).norm();
    for (int j = 0; j < 300; ++j) {
      double a = uniform(random), b = uniform(random);
      if (a + b > 1) {
        a = 1 - a;
        b = 1 - b;
      }
      REQUIRE(distance <= (at(triangle, {1 - a - b, a, b}) - p).norm() + 1e-14);
    }
  }
}

TEST_CASE("a path enters a triangle from its outer side only") {
  const TriangleCorners triangle{Vector3(0, 0, 0), Vector3(2, 0, 0), Vector3(0, 2, 0)};
  const auto in = crossing(triangle, {0.5, 0.5, 1}, {0.5, 0.5, -3});
  REQUIRE(in);
  CHECK(in->fraction == Approx(0.25));
  CHECK_FALSE(crossing(triangle, {0.5, 0.5, -1}, {0.5, 0.5, 1}));
  CHECK_FALSE(crossing(triangle, {3, 3, 1}, {3, 3, -1}));
  CHECK_FALSE(crossing(triangle, {0.5, 0.5, 2}, {0.5, 0.5, 1}));
}

TEST_CASE("surface tree finds the triangle that a search through all finds") {
  const Model model = test::synthetic_cube(5, 1, 1);
  const SurfaceTree tree(model.mesh);
  const auto count = static_cast<int>(model.mesh.triangles.rows());
  std::mt19937 random(2);
  for (int i = 0; i < 500; ++i) {
    const Vector3 p = random_point(random, 0.15);
    double nearest = std::numeric_limits<double>::infinity();
    const auto distance = [&](int t) {
      const TriangleCorners corners{model.mesh.rest_position(model.mesh.triangles(t, 0)),
                                    model.mesh.rest_position(model.mesh.triangles(t, 1)),
                                    model.mesh.rest_position(model.mesh.triangles(t, 2))};
      return (at(corners, closest_point(corners, p)) - p).norm();
    };
    for (int t = 0; t < count; ++t) nearest = std::min(nearest, distance(t));
    const int found = tree.closest_triangle(p);
    REQUIRE(distance(found) == Approx(nearest).margin(1e-15));
    for (const int guess : {i % count, count - 1, found}) {
      REQUIRE(tree.closest_triangle(p, guess) == found);
    }
  }
}

TEST_CASE("deformed surface gives the signed distance of the cube at rest") {
  const Model model = test::synthetic_cube(6, 1, 1);
  const RestSurface rest(model.mesh);
  DeformedSurface surface(rest);
  const FakeEngine engine(model.mesh, [](const Vector3&) -> Vector3 { return Vector3::Zero(); });
  std::mt19937 random(4);
  for (int i = 0; i < 1000; ++i) {
    surface.begin_step(engine);
    const Vector3 p = random_point(random, 0.1);
    const SurfaceHit hit = surface.closest(p);
    REQUIRE(hit.signed_distance == Approx(cube_distance(p, 0.06)).margin(1e-12));
  }
}

TEST_CASE("deformed surface follows displacements much larger than its triangles") {
  const Model model = test::synthetic_cube(6, 1, 1);
  const RestSurface rest(model.mesh);
  DeformedSurface surface(rest);
  // Squeezed to half, and shifted by a third of the edge: still a box, of which the distance is
  // known.
  const Vector3 scale(1.2, 0.5, 0.8);
  const Vector3 shift(0.04, -0.03, 0.02);
  const FakeEngine engine(
      model.mesh, [&](const Vector3& x) -> Vector3 { return scale.cwiseProduct(x) + shift - x; });
  std::mt19937 random(4);
  int wrong = 0;
  for (int i = 0; i < 1000; ++i) {
    surface.begin_step(engine);
    // Points within 1 cm of the deformed surface: where contacts are made.
    Vector3 x = random_point(random, 0.06);
    x[i % 3] = (i & 4) != 0 ? 0.06 : -0.06;
    const Vector3 p = scale.cwiseProduct(x) + shift + random_point(random, 0.01);
    const Vector3 d = (p - shift).cwiseAbs() - 0.06 * scale;
    const double expected = d.cwiseMax(0.0).norm() + std::min(d.maxCoeff(), 0.0);
    const SurfaceHit hit = surface.closest(p);
    if (std::abs(hit.signed_distance - expected) > 1e-12) ++wrong;
    const double limit = 0.5 * std::abs(expected) + 0.25 * std::abs(p.x());
    const double distance = std::min(std::abs(expected), limit);
    if (std::abs(surface.distance_up_to(limit, p, hit) - distance) > 1e-12) ++wrong;
  }
  CHECK(wrong == 0);
}

// Wedges of 25 degrees along each axis: at some of their corners one face has one triangle and the
// other two.
TEST_CASE("deformed surface: what is outside a sharp corner is outside, however it is meshed") {
  const Model model = test::synthetic_cube(2, 1, 1);
  const RestSurface rest(model.mesh);
  DeformedSurface surface(rest);
  const double angle = 25.0 * std::numbers::pi / 180.0;
  std::mt19937 random(8);
  for (int wedge = 0; wedge < 6; ++wedge) {
    const int i = wedge % 3;
    const int j = (i + 1) % 3;
    const double way = wedge < 3 ? 1.0 : -1.0;
    // The faces across i lean over along it.
    Matrix3 shear = Matrix3::Identity();
    shear.col(j) = std::cos(angle) * way * Vector3::Unit(i) + std::sin(angle) * Vector3::Unit(j);
    const FakeEngine engine(model.mesh, [&](const Vector3& x) -> Vector3 { return shear * x - x; });
    const Matrix3 across = shear.inverse();
    int nearest_is_corner = 0;
    for (int n = 0; n < 2000; ++n) {
      surface.begin_step(engine);
      Vector3 corner = Vector3::Constant((n & 1) != 0 ? 0.06 : -0.06);
      corner[j] = way * corner[i];
      if ((n & 2) != 0) corner[3 - i - j] *= -1.0;
      const Vector3 p = shear * corner + random_point(random, 0.01);
      const double outside = (across * p).cwiseAbs().maxCoeff() - 0.06;
      if (std::abs(outside) < 1e-9) continue;
      const SurfaceHit hit = surface.closest(p);
      CAPTURE(wedge, p.transpose(), hit.position.transpose());
      REQUIRE((hit.signed_distance > 0) == (outside > 0));
      if ((hit.position - shear * corner).norm() < 1e-12) ++nearest_is_corner;
    }
    CHECK(nearest_is_corner > 250);
  }
}

// The tree knows the rest shape alone: where the surface is displaced by 36 mm below and by 44 mm
// above, the way is sought within a quarter of that.
TEST_CASE(
    "deformed surface: a fast way meets a face that is displaced otherwise than where it ends") {
  const Model model = test::synthetic_cube(6, 1, 1);
  const RestSurface rest(model.mesh);
  DeformedSurface surface(rest);
  const FakeEngine engine(model.mesh, [&](const Vector3& x) -> Vector3 {
    return {0.040 + 0.004 * x.y() / 0.06, 0.0, 0.0};
  });
  surface.begin_step(engine);
  // In the rest shape it enters half a millimetre to one side of an edge between triangles, and the
  // way that is moved by what the end's surroundings are lies 7.5 mm to the other.
  const Vector3 from(0.0435, 0.1, 0.007);
  const Vector3 to(0.0435, -0.055, 0.007);
  const SurfaceHit near = surface.closest(to);
  CHECK(near.position.y() == Approx(-0.06));
  const auto found = surface.first_crossing(from, to, near);
  REQUIRE(found);
  CHECK((found->position - Vector3(0.0435, 0.06, 0.007)).norm() < 1e-12);
  CHECK(interpolate(found->point, [&](int i) { return rest.node(i); }).x() == Approx(-0.0005));
}

TEST_CASE("deformed surface computes a bounded number of nodes, each once a step") {
  int fewest = 1'000'000;
  int most = 0;
  for (const int cells : {4, 8, 16}) {
    const Model model = test::synthetic_cube(cells, 1, 1);
    const RestSurface rest(model.mesh);
    DeformedSurface surface(rest);
    const FakeEngine engine(model.mesh, [](const Vector3&) -> Vector3 { return Vector3::Zero(); });
    surface.begin_step(engine);
    surface.closest({0.01, 0.012, 0.065});
    const int once = engine.evaluations;
    surface.closest({0.01, 0.012, 0.065});
    CHECK(engine.evaluations == once);
    fewest = std::min(fewest, once);
    most = std::max(most, once);
  }
  CHECK(most <= 20);
  CHECK(most - fewest <= 4);
}

TEST_CASE(
    "a way is far from the deformed surface by its displacements' bound, and no node is asked") {
  const Model model = test::synthetic_cube(4, 1, 1);
  const RestSurface rest(model.mesh);
  DeformedSurface surface(rest);
  FakeEngine engine(model.mesh, [](const Vector3&) -> Vector3 { return Vector3(0.01, 0, 0); });
  const auto far = [&](const Vector3& from, const Vector3& to) {
    surface.begin_step(engine);
    return surface.is_far_from(from, to);
  };
  CHECK_FALSE(far({1, 1, 1}, {1, 1, 1}));  // no bound is known
  engine.bound = 0.01;
  CHECK(far({0.0701, 0, 0}, {0.0701, 0, 0}));
  CHECK_FALSE(far({0.0699, 0, 0}, {0.0699, 0, 0}));
  CHECK_FALSE(far({0.07, 0, 0}, {0.07, 0, 0}));
  CHECK_FALSE(far({0, 0, 0}, {0, 0, 0}));
  // From one side to the other, and past an edge.
  CHECK_FALSE(far({0.1, 0, 0}, {-0.1, 0, 0}));
  CHECK(far({0.1, 0.0701, 0}, {-0.1, 0.0701, 0}));
  engine.bound = 0.02;
  CHECK_FALSE(far({0.0701, 0, 0}, {0.0701, 0, 0}));
  CHECK(engine.evaluations == 0);
}

TEST_CASE("a god-object is the same whether far ways are known to be far or not") {
  const Model model = test::synthetic_cube(6, 1, 1);
  const RestSurface rest(model.mesh);
  FakeEngine searching(model.mesh, [](const Vector3& x) -> Vector3 {
    return 0.01 * Vector3(std::sin(40.0 * x.y()), std::cos(30.0 * x.z()), x.x() / 0.06);
  });
  FakeEngine bounded = searching;
  bounded.bound = 0.01;
  std::array<DeformedSurface, 2> surfaces{DeformedSurface(rest), DeformedSurface(rest)};
  std::array<GodObject, 2> styluses;
  std::mt19937 random(6);
  Vector3 tip(0, 0.2, 0);
  int touches = 0;
  for (int k = 0; k < 20'000; ++k) {
    // Long ways now and then: past the object, through it, and out of its inside.
    tip = k % 5 == 0 ? random_point(random, 0.15) : Vector3(tip + random_point(random, 0.01));
    surfaces[0].begin_step(searching);
    surfaces[1].begin_step(bounded);
    if (k % 97 == 0) {
      for (GodObject& stylus : styluses) stylus.forget();
    }
    const GodObject::Input input{tip, k % 7 == 0, 0.004};
    styluses[0].find(input, surfaces[0]);
    styluses[1].find(input, surfaces[1]);
    REQUIRE(styluses[0].state() == styluses[1].state());
    REQUIRE(styluses[0].outside() == styluses[1].outside());
    REQUIRE(styluses[0].triangle() == styluses[1].triangle());
    REQUIRE(styluses[0].point().weights == styluses[1].point().weights);
    if (styluses[0].state() == ContactState::kFree) continue;
    ++touches;
    for (GodObject& stylus : styluses) {
      if (k % 2 == 0) {
        stylus.release(tip);
      } else {
        stylus.reject_contact();
      }
    }
  }
  CHECK(touches > 1000);
  CHECK(bounded.evaluations < searching.evaluations);
}

// What is known of nodes from steps before may only spare work.
TEST_CASE("deformed surface: with bounded changes the hits are those without") {
  const Model model = test::synthetic_cube(6, 1, 1);
  const RestSurface rest(model.mesh);
  FakeEngine searching(model.mesh, [](const Vector3& x) -> Vector3 {
    return 0.01 * Vector3(std::sin(40.0 * x.y()), std::cos(30.0 * x.z()), x.x() / 0.06);
  });
  FakeEngine bounded = searching;
  DeformedSurface plain(rest);
  DeformedSurface sparing(rest);
  std::mt19937 random(7);
  Vector3 tip(0.01, 0.08, -0.02);
  int crossings = 0;
  for (int k = 0; k < 5000; ++k) {
    const double change = k % 1000 < 500 ? 1e-5 : 1e-3;
    std::vector<Vector3> moves;
    for (int i = 0; i < rest.node_count(); ++i) moves.push_back(random_point(random, change));
    searching.move(moves);
    bounded.move(moves);
    plain.begin_step(searching);
    sparing.begin_step(bounded, k % 300 == 0 ? DeformedSurface::kUnknown : change);
    const Vector3 before = tip;
    tip = k % 50 == 0 ? random_point(random, 0.12) : Vector3(tip + random_point(random, 0.003));
    const SurfaceHit expected = plain.closest(tip);
    const SurfaceHit hit = sparing.closest(tip);
    REQUIRE(hit.triangle == expected.triangle);
    REQUIRE(hit.position == expected.position);
    REQUIRE(hit.signed_distance == expected.signed_distance);
    const auto expected_crossing = plain.first_crossing(before, tip, expected);
    const auto crossing = sparing.first_crossing(before, tip, hit);
    REQUIRE(crossing.has_value() == expected_crossing.has_value());
    if (crossing) {
      ++crossings;
      REQUIRE(crossing->position == expected_crossing->position);
    }
    REQUIRE(std::ranges::equal(sparing.seen(), plain.seen()));
  }
  CHECK(crossings > 100);
  CHECK(bounded.evaluations < searching.evaluations);
}
