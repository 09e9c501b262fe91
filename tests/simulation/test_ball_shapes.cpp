// A ball meets bodies of many shapes where their surfaces are, at random places.
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <random>
#include <string>

#include "simulation/collision/rest_surface.hpp"
#include "simulation/step/simulation.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/voxel_body.hpp"

using namespace irdm;
using namespace irdm::test;

namespace {

// Maps a cube of edge 2 about the origin to the unit ball, so that grid lines stay apart.
Vector3 ball_of_cube(const Vector3& p) {
  const Vector3 q = p.cwiseProduct(p);
  return {p.x() * std::sqrt(1.0 - q.y() / 2.0 - q.z() / 2.0 + q.y() * q.z() / 3.0),
          p.y() * std::sqrt(1.0 - q.z() / 2.0 - q.x() / 2.0 + q.z() * q.x() / 3.0),
          p.z() * std::sqrt(1.0 - q.x() / 2.0 - q.y() / 2.0 + q.x() * q.y() / 3.0)};
}

// The same, with edges that are left a little, so that its cells can be bent.
Vector3 rounded_cube(const Vector3& p) {
  return 0.5 * ball_of_cube(p) + 0.4 * p;
}

// Positions of a grid's corners in a cube of edge 2 about the origin.
VoxelMesh mapped(const std::array<int, 3>& cells,
                 const std::function<Vector3(const Vector3&)>& map) {
  return {cells, {}, [=](const std::array<int, 3>& at) {
            return map({2.0 * at[0] / cells[0] - 1.0, 2.0 * at[1] / cells[1] - 1.0,
                        2.0 * at[2] / cells[2] - 1.0});
          }};
}

VoxelMesh voxels(const std::array<int, 3>& cells, double edge,
                 const std::function<bool(const std::array<int, 3>&)>& solid) {
  return {cells, solid, [=](const std::array<int, 3>& at) -> Vector3 {
            return edge * Vector3(at[0], at[1], at[2]);
          }};
}

// The paper's cube with a dent of radius 4 cm in its top, 3 cm deep.
Vector3 dented(const Vector3& p) {
  constexpr double kRadius = 0.04;
  constexpr double kDepth = 0.03;
  const double r = 0.06 * std::hypot(p.x(), p.z());
  const double rim = std::sqrt(kRadius * kRadius - std::pow(kRadius - kDepth, 2));
  double top = 0.06;
  if (r < rim) top += kRadius - kDepth - std::sqrt(kRadius * kRadius - r * r);
  return {0.06 * p.x(), -0.06 + (top + 0.06) * 0.5 * (p.y() + 1.0), 0.06 * p.z()};
}

std::map<std::string, VoxelMesh> shapes() {
  std::map<std::string, VoxelMesh> all;
  all["dent"] = mapped({8, 6, 8}, dented);
  all["ball"] =
      mapped({6, 6, 6}, [](const Vector3& p) -> Vector3 { return 0.05 * ball_of_cube(p); });
  all["kidney"] = mapped({8, 4, 5}, [](const Vector3& p) -> Vector3 {
    const Vector3 q = rounded_cube(p).cwiseProduct(Vector3(0.05, 0.018, 0.025));
    const double angle = q.x() / 0.04;
    return {(0.04 + q.z()) * std::sin(angle), q.y(), (0.04 + q.z()) * std::cos(angle)};
  });
  all["star"] = mapped({10, 4, 10}, [](const Vector3& p) -> Vector3 {
    const Vector3 q = rounded_cube(p);
    const double arms =
        1.0 + 0.2 * std::hypot(q.x(), q.z()) * std::cos(5.0 * std::atan2(q.z(), q.x()));
    return {0.05 * arms * q.x(), 0.02 * q.y(), 0.05 * arms * q.z()};
  });
  all["bowl"] = mapped({8, 3, 8}, [](const Vector3& p) -> Vector3 {
    const Vector3 disc = ball_of_cube({p.x(), 0.0, p.z()});
    const double polar = 1.2 * std::hypot(disc.x(), disc.z());
    const double radius = 0.06 - 0.006 * p.y();
    const double around = std::atan2(disc.z(), disc.x());
    return {radius * std::sin(polar) * std::cos(around), -radius * std::cos(polar),
            radius * std::sin(polar) * std::sin(around)};
  });
  all["plate of 2 mm"] = mapped({8, 1, 8}, [](const Vector3& p) -> Vector3 {
    return {0.04 * p.x(), 0.001 * p.y(), 0.04 * p.z()};
  });
  all["ring"] = mapped({20, 3, 3}, [](const Vector3& p) -> Vector3 {  // open at one place
    const Vector3 q = 0.012 * ball_of_cube({0.0, p.y(), p.z()});
    const double angle = 0.95 * std::numbers::pi * p.x();
    return {(0.04 + q.z()) * std::sin(angle), q.y(), (0.04 + q.z()) * std::cos(angle)};
  });
  all["L"] = voxels({6, 6, 3}, 0.02, [](const auto& at) { return at[0] < 3 || at[1] < 3; });
  all["finger with chambers"] = voxels({13, 4, 4}, 0.007, [](const auto& at) {
    return at[1] == 0 || at[0] % 2 == 0;  // plates on a strip
  });
  all["octopus"] = voxels({9, 5, 9}, 0.01, [](const auto& at) {
    const bool head = std::abs(at[0] - 4) <= 1 && std::abs(at[2] - 4) <= 1 && at[1] >= 2;
    const bool body = std::abs(at[0] - 4) <= 1 && std::abs(at[2] - 4) <= 1 && at[1] < 2;
    const int over = std::abs(at[0] - 4) - std::abs(at[2] - 4);
    const bool arm = at[1] == 0 && (at[0] == 4 || at[2] == 4 || over == 0 || over == 1);
    return head || body || arm;
  });
  return all;
}

// A point of the surface [m, B], and the outward normal there.
struct Place {
  Vector3 point;
  Vector3 normal;

  Vector3 at(double height) const { return point + height * normal; }
};

Place random_place(const RestSurface& surface, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const int t = std::uniform_int_distribution<int>(0, surface.triangle_count() - 1)(random);
  const TriangleCorners corners = surface.corners(t);
  double a = uniform(random);
  double b = uniform(random);
  if (a + b > 1.0) {
    a = 1.0 - a;
    b = 1.0 - b;
  }
  return {corners[0] + a * (corners[1] - corners[0]) + b * (corners[2] - corners[0]),
          area_normal(corners).normalized()};
}

double distance(const RestSurface& surface, const Vector3& x) {
  return (surface.closest(x).position - x).norm();
}

// A ball that comes to a place along the normal there.
struct Approach {
  Approach(Simulation& of, const RestSurface& on, const Place& to, double its_radius)
      : simulation(of), surface(on), place(to), radius(its_radius) {}

  void step(double height) {
    StylusCommand command;
    command.present = true;
    command.tip = place.at(height);
    simulation.step({&command, 1}, *record);
    force = record->stylus[0].force;
    if (first_depth != 0.0 || force.isZero(0.0)) return;
    const Vector3 away = command.tip - surface.closest(command.tip).position;
    first_depth = radius - away.norm();
    first_outward = force.dot(away);
  }
  void go(double from, double to, double way) {
    for (double height = from; height > to; height -= way) step(height);
  }

  Simulation& simulation;
  const RestSurface& surface;
  const Place& place;
  double radius;
  Vector3 force = Vector3::Zero();  // on the stylus [N]
  double first_depth = 0.0;         // below the surface at rest with the first force [m]
  double first_outward = 0.0;  // of the first force, away from the nearest point of the surface
  std::unique_ptr<StepRecord> record = std::make_unique<StepRecord>();
};

// Comes to random places of a shape, quickly and slowly. @param places for each radius
void check_touch(const std::string& name, int places) {
  const auto model =
      voxel_body(shapes().at(name), {.youngs_modulus = 2e4, .rayleigh_alpha = 60.0, .modes = 200});
  const RestSurface surface(model->mesh);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  int tried = 0;
  for (const double radius : {0.004, 0.01, 0.02}) {
    SimulationConfig config;
    config.objects.resize(1);
    config.objects[0].model = model;
    config.objects[0].friction = {0.0, 0.0};
    config.styluses = {{.radius = radius, .coupling_stiffness = 2000.0, .ball = true}};
    Simulation simulation(config);
    for (int i = 0; i < places; ++i) {
      const Place place = random_place(surface, random);
      const double speed = 0.02 * std::pow(25.0, uniform(random));  // 2 to 50 cm/s
      const double way = speed * model->dt;
      const double start = radius + 0.004 + way;
      if (distance(surface, place.at(start)) < radius + way) continue;  // beside another part
      ++tried;
      INFO(name << ", R " << radius << ", place " << i << ", " << speed << " m/s");
      Approach fast(simulation, surface, place, radius);
      fast.go(start, radius - std::min(0.25 * radius, 0.002), way);
      CHECK(fast.first_depth > 0.0);
      CHECK(fast.first_depth < way + 2e-4);
      CHECK(fast.first_outward > 0.0);
      simulation.reset();
      const double depth = radius - std::min(0.25 * radius, 0.002);
      Approach slow(simulation, surface, place, radius);
      slow.go(start, depth, 0.03 * model->dt);
      for (int k = 0; k < 150; ++k) slow.step(depth);
      CHECK(slow.force.norm() > 1e-3);
      simulation.reset();
    }
  }
  INFO(name << ": " << tried << " places");
  CHECK(tried >= places);  // many are beside another part of the body
}

}  // namespace

TEST_CASE("ball of a stylus: on many shapes it is felt from the drawn surface on", "[slow]") {
  for (const char* name : {"dent", "star", "plate of 2 mm", "octopus"}) check_touch(name, 3);
}

TEST_CASE("ball of a stylus: on ten shapes it is felt from the drawn surface on, at 30 places each",
          "[exhaustive]") {
  for (const auto& [name, mesh] : shapes()) check_touch(name, 10);
}

TEST_CASE("ball of a stylus: in a dent, a narrower ball meets its ground, and a wider one its rim",
          "[slow]") {
  // A patch of pressure felt nothing there to 30 mm inside the body, and 1.07 N in the first step.
  const auto model = voxel_body(shapes().at("dent"), {.youngs_modulus = 2e3, .modes = 200});
  const RestSurface surface(model->mesh);
  const Vector3 top = Vector3(0, 0.06, 0) - model->mesh.com_offset;
  for (const double radius : {0.007, 0.015, 0.0305, 0.05}) {
    SimulationConfig config;
    config.objects.resize(1);
    config.objects[0].model = model;
    config.objects[0].friction = {0.0, 0.0};
    config.styluses = {{.radius = radius, .ball = true}};
    Simulation simulation(config);
    const Place middle{top, Vector3::UnitY()};
    Approach down(simulation, surface, middle, radius);
    double height = radius + 0.002;
    const double way = 0.02 * model->dt;
    double first = 0.0;
    for (; down.first_depth == 0.0 && height > -0.1; height -= way) {
      down.step(height);
      first = down.force.norm();
    }
    INFO("R " << radius << ": first force " << first << " N at " << down.first_depth);
    CHECK(down.first_depth > 0.0);
    CHECK(down.first_depth < way + 2e-4);
    CHECK(first < 0.1);
    const double touched = height;
    for (; height > touched - 0.01; height -= way) {
      down.step(height);
      REQUIRE(down.force.y() > 0.0);
    }
    for (int k = 0; k < 200; ++k) down.step(height);
    CHECK(down.force.y() > 0.02);
    CHECK(std::hypot(down.force.x(), down.force.z()) < 0.1 * down.force.y());
  }
}

TEST_CASE("ball of a stylus: a crease is felt with both of its faces", "[slow]") {
  const auto model = voxel_body(shapes().at("L"), {.modes = 200});
  const Vector3 crease = Vector3(0.06, 0.06, 0.03) - model->mesh.com_offset;
  const double radius = GENERATE(0.004, 0.01, 0.02);
  SimulationConfig config;
  config.objects.resize(1);
  config.objects[0].model = model;
  config.objects[0].friction = {0.0, 0.0};
  config.styluses = {{.radius = radius, .coupling_stiffness = 1000.0, .ball = true}};
  Simulation simulation(config);
  const auto record = std::make_unique<StepRecord>();
  // Returns the force [N] that holds the ball at a place to which it has come along a way.
  const auto hold = [&](const Vector3& from, const Vector3& to) {
    simulation.reset();
    for (int k = 0; k <= 500; ++k) {
      StylusCommand command;
      command.present = true;
      command.tip = from + std::min(1.0, k / 300.0) * (to - from);
      simulation.step({&command, 1}, *record);
    }
    return record->stylus[0].force;
  };
  // At 45 degrees: 2 mm deep in both faces. The inner walls are x = 0.06 (above) and y = 0.06.
  const Vector3 beside(radius, radius, 0.0);
  const Vector3 outside(0.02, 0.02, 0.0);
  const Vector3 into = hold(crease + beside + outside, crease + beside - Vector3(2e-3, 2e-3, 0));
  CHECK(into.x() > 0.005);
  CHECK(into.y() > 0.005);
  // Down beside the inner wall, 1 mm deep in it: the wall is felt on the way, the ground below.
  const Vector3 wall = hold(crease + Vector3(radius - 1e-3, radius + 0.03, 0),
                            crease + Vector3(radius - 1e-3, radius + 0.01, 0));
  CHECK(wall.x() > 0.002);
  CHECK(std::abs(wall.y()) < 0.2 * wall.x());
  const Vector3 ground = hold(crease + Vector3(radius - 1e-3, radius + 0.03, 0),
                              crease + Vector3(radius - 1e-3, radius - 2e-3, 0));
  CHECK(ground.x() > 0.002);
  CHECK(ground.y() > 0.005);
}
