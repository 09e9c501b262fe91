// The measure of how deep nodes are inside other bodies, on a cube whose distances are known.

#include "tests/support/catch.hpp"
#include "tests/system/penetration.hpp"

using namespace irdm;
using namespace irdm::test;

namespace {

// Of the cube from -1 to 1, two triangles a face.
std::vector<std::array<Vector3, 3>> cube_triangles() {
  std::vector<std::array<Vector3, 3>> all;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      const Vector3 n = side * Vector3::Unit(axis);
      const Vector3 a = Vector3::Unit((axis + 1) % 3);
      const Vector3 b = side * Vector3::Unit((axis + 2) % 3);
      all.push_back({n - a - b, n + a - b, n + a + b});
      all.push_back({n - a - b, n + a + b, n - a + b});
    }
  }
  return all;
}

}  // namespace

TEST_CASE("penetration: distance from a cube, beside faces, edges and corners, and inside") {
  const auto cube = cube_triangles();
  CHECK(signed_distance(cube, {0.3, 1.5, -0.2}) == Approx(0.5));
  CHECK(signed_distance(cube, {1.3, 1.4, 0.1}) == Approx(0.5));
  CHECK(signed_distance(cube, {-2.0, 3.0, -3.0}) == Approx(3.0));
  CHECK(signed_distance(cube, {0.1, -0.2, 0.75}) == Approx(-0.25));
  CHECK(signed_distance(cube, {0.9, -0.95, 0.99}) == Approx(-0.01));
  CHECK(signed_distance(cube, Vector3::Zero()) == Approx(-1.0));
}
