// What a fingertip presses on, and that the force under it is the object's, not the mesh's.
#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <map>
#include <numeric>

#include "precompute/mesh/box_mesh.hpp"
#include "simulation/contact/pressure_mask.hpp"
#include "simulation/contact/smoothed_surface.hpp"
#include "tests/simulation/pressed_cube.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/static_cube.hpp"

using namespace irdm;
using namespace irdm::test;

namespace {

const Vector3 kOutward(0, 1, 0);

ContactPatch patch_at(const RestSurface& surface, double radius, double x, double z) {
  PressureMask mask(surface, radius);
  ContactPatch patch;
  mask.spread(surface.closest({x, kHalfEdge, z}).point, patch);
  return patch;
}

double largest_over_least(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end()) /
         *std::min_element(values.begin(), values.end());
}

}  // namespace

TEST_CASE("fingertip: the mask of a fingertip sums to one, is symmetric, and moves smoothly",
          "[slow]") {
  const auto model = fem_cube({8});
  const RestSurface surface(model->mesh);
  PressureMask mask(surface, 0.015);
  ContactPatch before, now;
  double largest = 0.0;
  for (int k = 0; k <= 400; ++k) {
    const SurfaceLocation middle = surface.closest({-0.04 + 0.0002 * k, kHalfEdge, 0.011});
    mask.spread(middle.point, now);
    double sum = 0.0;
    Vector3 centre = Vector3::Zero();
    for (std::size_t i = 0; i < static_cast<std::size_t>(now.count); ++i) {
      REQUIRE(now.weights[i] >= 0.0);
      sum += now.weights[i];
      centre += now.weights[i] * surface.node(now.nodes[i]);
    }
    REQUIRE(sum == Approx(1.0).epsilon(1e-12));
    REQUIRE((centre - middle.position).norm() < 1e-3);
    if (k > 0) {
      std::map<int, double> change;
      for (std::size_t i = 0; i < static_cast<std::size_t>(now.count); ++i)
        change[now.nodes[i]] += now.weights[i];
      for (std::size_t i = 0; i < static_cast<std::size_t>(before.count); ++i)
        change[before.nodes[i]] -= before.weights[i];
      for (const auto& [node, difference] : change)
        largest = std::max(largest, std::abs(difference));
    }
    before = now;
  }
  CHECK(largest < 0.02);  // 0.2 mm of a fingertip of 15 mm
}

TEST_CASE("fingertip: what is kept of a middle that stays is that middle's") {
  const auto model = fem_cube({3});
  const RestSurface surface(model->mesh);
  const std::array middles{surface.closest({0.01, kHalfEdge, 0.02}).point,
                           surface.closest({0.01, kHalfEdge, 0.03}).point,
                           surface.closest({0.0105, kHalfEdge, 0.03}).point};
  PressureMask mask(surface, 0.04);
  SmoothedSurface felt(surface, 0.04);
  for (const std::size_t i : {0UL, 0UL, 1UL, 2UL, 2UL, 0UL}) {
    ContactPatch kept, made;
    mask.spread(middles[i], kept);
    PressureMask(surface, 0.04).spread(middles[i], made);
    REQUIRE(kept.count == made.count);
    for (std::size_t j = 0; j < static_cast<std::size_t>(made.count); ++j) {
      CHECK(kept.nodes[j] == made.nodes[j]);
      CHECK(kept.weights[j] == made.weights[j]);
    }
    SmoothedSurface fresh(surface, 0.04);
    CHECK(felt.at(middles[i]).position == fresh.at(middles[i]).position);
    CHECK(felt.at(middles[i]).normal == fresh.at(middles[i]).normal);
  }
}

TEST_CASE("fingertip: the force spreads as wide as asked on any mesh that is fine enough") {
  // The pressure 1 - s^2 has a mean square distance of a third of the radius squared.
  for (const int cells : {8, 12, 20}) {
    const ModelMesh mesh = StaticCube(cells, 0.3, 1).mesh();
    const RestSurface surface(mesh);
    double mean_square = 0.0;
    int places = 0;
    for (double x = -0.02; x <= 0.02; x += 0.0037) {
      for (double z = -0.02; z <= 0.02; z += 0.0043) {
        const ContactPatch patch = patch_at(surface, 0.02, x, z);
        for (std::size_t i = 0; i < static_cast<std::size_t>(patch.count); ++i) {
          mean_square += patch.weights[i] *
                         (surface.node(patch.nodes[i]) - Vector3(x, kHalfEdge, z)).squaredNorm();
        }
        ++places;
      }
    }
    INFO(cells << " cells");
    CHECK(mean_square / places == Approx(0.02 * 0.02 / 3.0).epsilon(0.02));
  }
}

TEST_CASE("fingertip: where the mesh is much finer than elsewhere no part of the force is lost") {
  // Cells of the inner 60 % of each face are shorter: the largest tip covers those.
  const double shorter = GENERATE(0.9, 0.8, 0.6, 0.3);
  INFO("inner cells " << shorter << " times as long");
  const precompute::SurfaceMesh even =
      precompute::box_surface(Vector3::Constant(2 * kHalfEdge), {40, 40, 40});
  ModelMesh mesh;
  mesh.triangles = even.triangles;
  mesh.nodes = even.nodes.unaryExpr([shorter](double place) {
    const double x = place / kHalfEdge - 1.0;
    const double outside = std::max(0.0, std::abs(x) - 0.6);
    const double longer = (1.0 - 0.6 * shorter) / 0.4;
    return kHalfEdge * std::copysign(shorter * std::min(0.6, std::abs(x)) + longer * outside, x);
  });
  mesh.surface_nodes.resize(static_cast<std::size_t>(mesh.nodes.rows()));
  std::iota(mesh.surface_nodes.begin(), mesh.surface_nodes.end(), 0);
  const RestSurface surface(mesh);
  const double radius = PressureMask::largest_radius(surface);
  for (const double x : {0.0, 0.004}) {
    const ContactPatch patch = patch_at(surface, radius, x, 0.0);
    Vector3 centre = Vector3::Zero();
    double mean_square = 0.0, sum = 0.0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(patch.count); ++i) {
      const Vector3 away = surface.node(patch.nodes[i]) - Vector3(x, kHalfEdge, 0.0);
      sum += patch.weights[i];
      centre += patch.weights[i] * away;
      mean_square += patch.weights[i] * away.squaredNorm();
    }
    CHECK(sum == Approx(1.0).epsilon(1e-12));
    CHECK(centre.norm() < 0.02 * radius);
    CHECK(mean_square == Approx(radius * radius / 3.0).epsilon(0.05));
  }
}

TEST_CASE("fingertip: at rest the force is that of a static solve on the whole mesh", "[slow]") {
  const double radius = GENERATE(0.0, 0.015);
  FemCube cube;
  cube.cells = 4;
  cube.order = 2;
  cube.poisson_ratio = 0.3;
  SimulationConfig config = tethered(cube, radius, {0.5, 0.5});
  config.styluses[0].coupling_stiffness = 0.0;
  Simulation simulation(config);
  StepRecord record;
  Vector3 tip;
  for (int k = 0; k < 4000; ++k) {
    // Held as soon as it touches, so that it stays where it came down.
    tip = press(0.002 * (k + 1), 0.01, 0.003, 0.004);
    const StylusCommand command = at_tip(tip, true);
    simulation.step({&command, 1}, record);
  }
  const ContactRecord& contact = record.object[0].contact[0];
  REQUIRE(contact.state == ContactState::kHeld);
  const RestSurface& surface = simulation.object().surface();
  PressureMask mask(surface, radius);
  ContactPatch patch;
  mask.spread(contact.point, patch);
  const StaticCube reference(4, 0.3, 2);
  const Vector3 moved =
      record.object[0].orientation.conjugate() * (tip - record.object[0].position) -
      mean(patch, [&](int i) { return surface.node(i); });
  const Vector3 expected = reference.compliance(patch).ldlt().solve(moved);
  CHECK((contact.force - expected).norm() < 1e-3 * expected.norm());
}

TEST_CASE("fingertip: the force at an indentation does not depend on the mesh", "[slow]") {
  // 1 cm with a tip of 1.5 cm; quadratic elements, since linear ones are themselves too stiff.
  for (const Vector3& place : {Vector3(0.003, 0.0, 0.004), Vector3(0.02, 0.0, -0.01)}) {
    std::vector<double> tip, point;
    for (const int cells : {6, 8, 10}) {
      const StaticCube cube(cells, 0.3, 2);
      const ModelMesh mesh = cube.mesh();
      const RestSurface surface(mesh);
      const auto force = [&](double radius) {
        return 0.01 /
               kOutward.dot(cube.compliance(patch_at(surface, radius, place.x(), place.z())) *
                            kOutward);
      };
      tip.push_back(force(0.015));
      point.push_back(force(0.0));
    }
    std::cout << "at " << place.x() << ", " << place.z() << ": fingertip " << tip[0] << " "
              << tip[1] << " " << tip[2] << " N, a factor of " << largest_over_least(tip)
              << "; point " << point[0] << " " << point[1] << " " << point[2] << " N, "
              << largest_over_least(point) << "\n";
    CHECK(largest_over_least(tip) < 1.05);
    CHECK(largest_over_least(point) > 1.05);
  }
}
