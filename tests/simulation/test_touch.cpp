// What tips feel on an object: friction, fingertips, taking hold and letting go.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <random>

#include "server/step/simulation.hpp"
#include "tests/support/fem_cube.hpp"

using namespace irdm;
using namespace irdm::test;

namespace {

constexpr double kHalfEdge = 0.06;

// The paper's cube, brought home by a tether and slowed down, so that it can be pressed.
SimulationConfig tethered(const FemCube& cube, double radius, const Friction& friction) {
  SimulationConfig config;
  config.objects.resize(1);
  SimulationObject& object = config.objects[0];
  object.model = fem_cube(cube);
  object.friction = friction;
  object.tether = {1000.0, 10.0};
  object.damping = {20.0, 20.0};
  config.styluses = {{radius, 2000.0, 0.0}};
  return config;
}

StylusCommand at_tip(const Vector3& tip, bool grab = false) {
  return {true, grab ? kGrabButton : 0u, tip, std::nullopt};
}

// Comes down on the top at (x, z) to a depth within 0.5 s.
Vector3 press(double t, double depth, double x, double z) {
  const double s = std::clamp(t / 0.5, 0.0, 1.0);
  return {x, kHalfEdge + 0.005 - (0.005 + depth) * s * s * (3 - 2 * s), z};
}

}  // namespace

TEST_CASE(
    "touch: dragged sideways a tip sticks, then slips with kinetic friction, against its way") {
  const Friction friction{0.6, 0.4};
  Simulation simulation(tethered({}, 0.0, friction));
  StepRecord record;
  bool stuck = false;
  int slipping = 0;
  for (int k = 0; k < 1000; ++k) {
    const double t = 0.002 * (k + 1);
    Vector3 tip = press(t, 0.004, -0.03, 0.0);
    tip.x() += 0.03 * std::max(0.0, t - 0.7);
    const StylusCommand command = at_tip(tip);
    simulation.step({&command, 1}, record);
    const ContactRecord& contact = record.object[0].contact[0];
    if (t < 0.6) continue;
    REQUIRE(contact.state == ContactState::kTouching);
    const Vector3& n = contact.normal;
    const double push = -contact.force.dot(n);
    const Vector3 along = contact.force + push * n;
    REQUIRE(push > 0);
    REQUIRE(along.norm() <= 0.6 * push * (1 + 1e-9));
    if (contact.slipping) {
      ++slipping;
      REQUIRE(along.norm() == Approx(0.4 * push).epsilon(1e-9));
      if (t > 1.2) REQUIRE(along.x() > 0.9 * along.norm());  // the object is dragged along
    } else if (slipping == 0 && along.norm() > 0.3 * push) {
      stuck = true;
    }
  }
  CHECK(stuck);
  CHECK(slipping > 200);
}

TEST_CASE("touch: without friction the force stays normal to the deformed surface") {
  Simulation simulation(tethered({8}, 0.015, {0.0, 0.0}));
  const RestSurface& surface = simulation.object().surface();
  StepRecord record;
  double largest_turn = 0.0;
  Points u;
  for (int k = 0; k < 800; ++k) {
    const double t = 0.002 * (k + 1);
    Vector3 tip = press(t, 0.01, -0.02, 0.01);
    tip.x() += 0.04 * std::max(0.0, t - 0.6);
    // The area vector of all triangles near the tip is that of the loop round them, whatever is
    // inside: a normal that knows nothing of how the contact's was found. As the step found it,
    // with what was there before.
    simulation.object().engine().displacement(u);
    const StylusCommand command = at_tip(tip);
    simulation.step({&command, 1}, record);
    const ContactRecord& contact = record.object[0].contact[0];
    if (contact.state == ContactState::kFree) continue;
    const Vector3& n = contact.normal;
    REQUIRE((contact.force + contact.force.norm() * n).norm() < 1e-9);
    const Vector3 middle = interpolate(contact.point, [&](int i) { return surface.node(i); });
    Vector3 area = Vector3::Zero();
    Vector3 area_at_rest = Vector3::Zero();
    for (int triangle = 0; triangle < 12 * 8 * 8; ++triangle) {
      TriangleCorners corners = surface.corners(triangle);
      const Vector3 centre = (corners[0] + corners[1] + corners[2]) / 3.0;
      if ((centre - middle).norm() > 0.02 || centre.y() < kHalfEdge - 1e-9) continue;
      area_at_rest += area_normal(corners);
      for (std::size_t i = 0; i < 3; ++i) {
        corners[i] += u.row(surface.topology().corners(triangle)[i]).transpose();
      }
      area += area_normal(corners);
    }
    REQUIRE(n.dot(area.normalized()) > 0.995);  // 6 degrees
    largest_turn = std::max(largest_turn, (n - area_at_rest.normalized()).norm());
  }
  CHECK(record.object[0].contact[0].state == ContactState::kTouching);
  CHECK(largest_turn > 0.05);
}

namespace {

// A tour round a rectangle of half-widths a and b with its corners rounded [m], from the middle of
// its top towards +x, after a way s: place in the plane.
Eigen::Vector2d rounded_rectangle(double s, double a, double b, double radius) {
  const double across = a - radius;
  const double up = b - radius;
  const double arc = 0.5 * std::numbers::pi * radius;
  s = std::fmod(s, 4.0 * (across + up + arc));
  const auto side = [](double length, double at) { return std::min(length, at); };
  Eigen::Vector2d place(0.0, b);
  double heading = 0.0;
  const std::array<double, 5> lengths{across, 2 * up, 2 * across, 2 * up, across};
  for (const double length : lengths) {
    const Eigen::Vector2d ahead(std::cos(heading), std::sin(heading));
    place += side(length, s) * ahead;
    s -= length;
    if (s <= 0) return place;
    const double turned = side(arc, s) / radius;
    const Eigen::Vector2d right(ahead.y(), -ahead.x());
    place += radius * (std::sin(turned) * ahead + (1.0 - std::cos(turned)) * right);
    s -= arc;
    if (s <= 0) return place;
    heading -= 0.5 * std::numbers::pi;
  }
  return place;
}

struct Tour {
  double peak = 0.0;
  double largest_step = 0.0;  // of |force| from one step to the next
  int lost = 0;               // steps without contact
  double off_surface = 0.0;   // of the proxy's material point
};

// Once round the cube and a little more, in the upright plane at an angle to the x axis, the tip a
// depth inside its faces; turns have the radius of 1 cm that a hand can follow.
Tour tour(const SimulationConfig& config, double angle, double speed, double depth) {
  constexpr double kTurn = 0.01;
  const Vector3 across(std::cos(angle), 0.0, std::sin(angle));
  const Vector3 beside = angle == 0.0 ? Vector3(0.0, 0.0, 0.0077) : Vector3::Zero();
  const double b = kHalfEdge - depth;
  const double a = b / std::cos(angle);
  const double once = 4.0 * (a + b - 2.0 * kTurn) + 2.0 * std::numbers::pi * kTurn;
  Simulation simulation(config);
  const RestSurface& surface = simulation.object().surface();
  StepRecord record;
  Tour result;
  double last = 0.0;
  constexpr int kDown = 250;
  const int steps = static_cast<int>(1.1 * once / speed / 0.002);
  for (int k = -kDown; k < steps; ++k) {
    const double t = 0.002 * k;
    const double s = t < 0 ? 0.0 : t < 0.1 ? 5.0 * speed * t * t : speed * (t - 0.05);
    const double above = k < 0 ? 1.0 - (k + kDown) / static_cast<double>(kDown) : 0.0;
    const Eigen::Vector2d at = rounded_rectangle(s, a, b, kTurn);
    const Vector3 tip = at.x() * across + Vector3(0.0, at.y() + 0.006 * above, 0.0) + beside;
    const StylusCommand command = at_tip(tip);
    simulation.step({&command, 1}, record);
    const double now = record.stylus[0].force.norm();
    if (k > 0) {
      if (record.stylus[0].contact == ContactState::kFree) ++result.lost;
      result.peak = std::max(result.peak, now);
      result.largest_step = std::max(result.largest_step, std::abs(now - last));
      const SurfacePoint& point = record.object[0].contact[0].point;
      const Vector3 at_rest = interpolate(point, [&](int i) { return surface.node(i); });
      result.off_surface =
          std::max(result.off_surface, (surface.closest(at_rest).position - at_rest).norm());
    }
    last = now;
  }
  return result;
}

}  // namespace

TEST_CASE("touch: sliding over faces and edges is smooth, and the proxy stays on the surface") {
  const double speed = GENERATE(0.02, 0.05, 0.1);
  const double degrees = GENERATE(0.0, 20.0);
  const double angle = degrees * std::numbers::pi / 180.0;
  const Tour result = tour(tethered({8}, 0.015, {0.2, 0.2}), angle, speed, 0.004);
  INFO(degrees << " degrees, " << speed << " m/s: peak " << result.peak << " N, largest step "
               << result.largest_step << " N, lost " << result.lost);
  CHECK(result.lost == 0);
  CHECK(result.off_surface < 1e-6);
  CHECK(result.largest_step < 0.05 * result.peak);
}

TEST_CASE("touch: sliding over corners and along edges is smooth") {
  const double speed = GENERATE(0.02, 0.05, 0.1);
  const Tour result = tour(tethered({8}, 0.015, {0.2, 0.2}), 0.25 * std::numbers::pi, speed, 0.004);
  INFO(speed << " m/s: peak " << result.peak << " N, largest step " << result.largest_step
             << " N, lost " << result.lost);
  CHECK(result.lost == 0);
  CHECK(result.off_surface < 1e-6);
  CHECK(result.largest_step < 0.05 * result.peak);
}

TEST_CASE("touch: a tip at 2 m/s does not pass through, nor through a corner") {
  for (const Vector3& from :
       {Vector3(0.1, 0.0, 0.0), Vector3(0.08, 0.08, 0.075), Vector3(-0.01, 0.1, 0.02)}) {
    SimulationConfig config = tethered({}, 0.0, {0.5, 0.5});
    Simulation simulation(config);
    StepRecord record;
    int touched = 0;
    const Vector3 way = -from.normalized();
    for (int k = 0; k < 60; ++k) {
      const StylusCommand command = at_tip(from + way * 2.0 * 0.002 * k);
      simulation.step({&command, 1}, record);
      const Vector3 in_body =
          record.object[0].orientation.conjugate() * (command.tip - record.object[0].position);
      if (in_body.cwiseAbs().maxCoeff() < kHalfEdge - 0.005) {
        REQUIRE(record.stylus[0].contact == ContactState::kTouching);
        ++touched;
      }
    }
    CHECK(touched > 5);
  }
}

TEST_CASE("touch: the force under a fingertip does not depend on the mesh") {
  const auto force = [](int cells, double radius) {
    FemCube cube;
    cube.cells = cells;
    cube.order = 2;  // linear tetrahedra are themselves too stiff, the more so the coarser
    cube.poisson_ratio = 0.3;
    Simulation simulation(tethered(cube, radius, {0.5, 0.5}));
    StepRecord record;
    for (int k = 0; k < 1500; ++k) {
      const StylusCommand command = at_tip(press(0.002 * (k + 1), 0.01, 0.003, 0.004));
      simulation.step({&command, 1}, record);
    }
    return record.stylus[0].force.norm();
  };
  std::vector<double> tip, point;
  for (const int cells : {3, 4, 6}) {
    tip.push_back(force(cells, 0.015));
    point.push_back(force(cells, 0.0));
  }
  INFO("fingertip " << tip[0] << " " << tip[1] << " " << tip[2] << " N, point " << point[0] << " "
                    << point[1] << " " << point[2] << " N");
  CHECK(*std::max_element(tip.begin(), tip.end()) <
        1.05 * *std::min_element(tip.begin(), tip.end()));
}

TEST_CASE("touch: the mask of a fingertip sums to one, is symmetric, and moves smoothly") {
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

TEST_CASE(
    "touch: within reach the grab button holds the nearest node at its offset, without a force") {
  SimulationConfig config = tethered({}, 0.0, {0.5, 0.5});
  config.styluses[0].reach = 0.01;
  Simulation simulation(config);
  StepRecord record;
  for (int k = 0; k < 100; ++k) {
    const StylusCommand command = at_tip({0.002, kHalfEdge + 0.006, 0.001}, k >= 50);
    simulation.step({&command, 1}, record);
    REQUIRE((record.stylus[0].contact == ContactState::kHeld) == (k >= 50));
    REQUIRE(record.stylus[0].force.norm() < 1e-9);
  }
  CHECK((record.object[0].contact[0].offset.y()) == Approx(0.006).margin(1e-9));
  // Pulled away, it follows.
  for (int k = 0; k < 500; ++k) {
    const StylusCommand command = at_tip({0.002, kHalfEdge + 0.006 + 1e-5 * k, 0.001}, true);
    simulation.step({&command, 1}, record);
  }
  CHECK(record.stylus[0].force.y() < -0.1);
  CHECK(record.object[0].position.y() > 1e-4);
}

TEST_CASE(
    "touch: letting go of a point that pulls takes the force off within the release time, without "
    "a jump") {
  SimulationConfig config = tethered({}, 0.0, {0.5, 0.5});
  config.styluses[0].reach = 0.01;
  Simulation simulation(config);
  StepRecord record;
  double before = 0.0;
  double largest_drop = 0.0;
  double pulled = 0.0;
  for (int k = 0; k < 700; ++k) {
    const double up = 0.004 * std::min(1.0, k / 300.0);
    const StylusCommand command = at_tip({0.002, kHalfEdge + 0.006 + up, 0.001}, k < 600);
    simulation.step({&command, 1}, record);
    const double now = record.stylus[0].force.norm();
    if (k == 599) pulled = now;
    if (k >= 600) largest_drop = std::max(largest_drop, before - now);
    if (k >= 620) REQUIRE(now == 0.0);
    before = now;
  }
  CHECK(pulled > 0.2);
  CHECK(largest_drop < 0.35 * pulled);
}

TEST_CASE("touch: over closed cycles of motion a stylus never gets out more than it put in") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int cycle = 0; cycle < 40; ++cycle) {
    FemCube cube;
    SimulationConfig config = tethered(cube, cycle % 2 == 0 ? 0.012 : 0.0, {0.5, 0.4});
    Simulation simulation(config);
    const Vector3 where(0.03 * uniform(random), 0.0, 0.03 * uniform(random));
    const Vector3 drag(0.03 * uniform(random), 0.0, 0.03 * uniform(random));
    const double depth = 0.003 + 0.002 * uniform(random);
    const bool grab = cycle % 3 == 0;
    StepRecord record;
    double work = 0.0;  // done by the stylus on the object
    double put_in = 0.0;
    Vector3 last_tip = Vector3(where.x(), kHalfEdge + 0.005, where.z());
    for (int k = 0; k < 2000; ++k) {
      const double t = 0.002 * (k + 1);
      const double down = std::sin(std::numbers::pi * std::clamp(t / 1.5, 0.0, 1.0));
      const double across = std::sin(std::numbers::pi * std::clamp((t - 0.4) / 0.8, 0.0, 1.0));
      const Vector3 tip =
          Vector3(where.x(), kHalfEdge + 0.005 - (0.005 + depth) * down, where.z()) + across * drag;
      const StylusCommand command = at_tip(tip, grab && t > 0.5 && t < 1.0);
      simulation.step({&command, 1}, record);
      const double done = -record.stylus[0].force.dot(tip - last_tip);
      work += done;
      put_in += std::max(0.0, done);
      last_tip = tip;
    }
    INFO("cycle " << cycle << ": " << work << " J of " << put_in << " J");
    CHECK(put_in > 0.0);
    CHECK(work > -0.01 * put_in);
  }
}

TEST_CASE("touch: two objects are felt by the same stylus, each for itself") {
  SimulationConfig config = tethered({}, 0.0, {0.5, 0.5});
  config.objects.push_back(config.objects[0]);
  config.objects[1].position = Vector3(0.3, 0.0, 0.0);
  Simulation both(config);
  Simulation alone(tethered({}, 0.0, {0.5, 0.5}));
  StepRecord two, one;
  bool second = false;
  for (int k = 0; k < 1500; ++k) {
    const double t = 0.002 * (k + 1);
    const Vector3 tip = press(std::fmod(t, 1.5), 0.004, t > 1.5 ? 0.3 : 0.0, 0.0);
    const StylusCommand command = at_tip(tip);
    both.step({&command, 1}, two);
    alone.step({&command, 1}, one);
    if (t <= 1.5) {
      REQUIRE(two.stylus[0].force == one.stylus[0].force);
      REQUIRE(two.object[1].position == config.objects[1].position);
    } else if (two.stylus[0].contact != ContactState::kFree) {
      REQUIRE(two.stylus[0].object == 1);
      second = true;
    }
  }
  CHECK(second);
}

TEST_CASE("touch: two fingers that pinch push against each other") {
  SimulationConfig config = tethered({}, 0.01, {0.8, 0.8});
  config.objects[0].tether = {};
  config.objects[0].damping = {};
  config.styluses = {{0.01, 2000.0, 0.0}, {0.01, 2000.0, 0.0}};
  Simulation simulation(config);
  StepRecord record;
  for (int k = 0; k < 4000; ++k) {
    const double depth = 0.004 * std::min(1.0, k / 300.0);
    const double lift = 0.05 * std::clamp((k - 500) / 500.0, 0.0, 1.0);
    const std::array<StylusCommand, 2> commands{at_tip({kHalfEdge + 0.001 - depth, lift, 0.0}),
                                                at_tip({-kHalfEdge - 0.001 + depth, lift, 0.0})};
    simulation.step(commands, record);
  }
  CHECK(record.stylus[0].force.x() > 0.1);
  CHECK((record.stylus[0].force + record.stylus[1].force).norm() <
        0.02 * record.stylus[0].force.norm());
  CHECK(record.object[0].position.y() == Approx(0.05).margin(0.002));
}
