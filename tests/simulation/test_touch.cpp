// What tips feel on an object: friction, fingertips, taking hold and letting go.
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <random>

#include "tests/simulation/pressed_cube.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;
using namespace irdm::test;

TEST_CASE("touch: dragged sideways a tip sticks, then slips with kinetic friction, against its way",
          "[unsanitized]") {
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
    // The tip goes on at 3 cm/s, so what slips is to slip on: no stick-slip.
    REQUIRE((slipping == 0 || contact.slipping));
    if (contact.slipping) {
      ++slipping;
      REQUIRE(along.norm() == Approx(0.4 * push).epsilon(1e-9));
      if (t > 1.2) REQUIRE(along.x() > 0.9 * along.norm());  // the object is dragged along
    } else if (slipping == 0 && along.norm() > 0.3 * push) {
      stuck = true;
    }
  }
  CHECK(stuck);
  CHECK(slipping > 500);  // of the 650 steps in which it is dragged
}

TEST_CASE("touch: without friction the force stays normal to the surface", "[slow]") {
  Simulation simulation(tethered({8}, 0.015, {0.0, 0.0}));
  StepRecord record;
  bool flat = false;
  bool edge = false;
  for (int k = 0; k < 1200; ++k) {
    const double t = 0.002 * (k + 1);
    Vector3 tip = press(t, 0.004, 0.0, 0.01);
    tip.x() += 0.04 * std::max(0.0, t - 0.6);
    const StylusCommand command = at_tip(tip);
    simulation.step({&command, 1}, record);
    const ContactRecord& contact = record.object[0].contact[0];
    if (contact.state == ContactState::kFree) continue;
    const Vector3& n = contact.normal;
    REQUIRE((contact.force + contact.force.norm() * n).norm() < 1e-9);
    const Vector3 middle =
        interpolate(contact.point, [&](int i) { return simulation.object().surface().node(i); });
    // On the top the normal is upward; near the edge it leans over to the side.
    if (middle.x() < 0.03) {
      REQUIRE(n.y() == Approx(1.0));
      flat = true;
    } else if (middle.x() > 0.055) {
      REQUIRE(n.x() > 0.3);
      edge = true;
    }
  }
  CHECK(flat);
  CHECK(edge);
}

TEST_CASE("touch: a tip at 2 m/s does not pass through, nor through a corner", "[slow]") {
  for (const Vector3& from :
       {Vector3(0.1, 0.0, 0.0), Vector3(0.08, 0.08, 0.075), Vector3(-0.01, 0.1, 0.02)}) {
    SimulationConfig config = tethered({8}, 0.0, {0.5, 0.5});
    Simulation simulation(config);
    StepRecord record;
    int touched = 0;
    const Vector3 way = -from.normalized();
    for (int k = 0; k < 60; ++k) {
      const StylusCommand command = at_tip(from + way * 2.0 * 0.002 * k);
      simulation.step({&command, 1}, record);
      const Vector3 in_body =
          record.object[0].orientation.conjugate() * (command.tip - record.object[0].position);
      if (in_body.cwiseAbs().maxCoeff() < kHalfEdge - 0.01) {
        REQUIRE(record.stylus[0].contact == ContactState::kTouching);
        ++touched;
      }
    }
    CHECK(touched > 5);
  }
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

TEST_CASE("touch: a given contact stays where it is given, after one that just began, too",
          "[slow]") {
  Simulation simulation(tethered({8}, 0.0, {0.5, 0.5}));
  StepRecord record;
  StylusCommand command = at_tip({0.05, kHalfEdge + 0.001, 0.003});
  simulation.step({&command, 1}, record);
  command.tip.y() = kHalfEdge - 0.006;  // below where the rounded edge is felt
  simulation.step({&command, 1}, record);
  REQUIRE(record.stylus[0].contact == ContactState::kTouching);
  const SurfacePoint point = simulation.object().surface().closest({0.05, kHalfEdge, -0.02}).point;
  command.given = GivenForce{ContactState::kTouching, point, Vector3(0, -0.1, 0), 0};
  simulation.step({&command, 1}, record);
  CHECK(record.object[0].contact[0].point.nodes == point.nodes);
  CHECK(record.object[0].contact[0].point.weights == point.weights);
}

TEST_CASE("touch: a grab that begins with the contact makes no jump, near an edge either",
          "[slow]") {
  for (const double x : {0.0, 0.045, 0.055}) {
    double largest = 0.0;
    for (const bool grab : {false, true}) {
      Simulation simulation(tethered({8}, 0.015, {0.5, 0.5}));
      StepRecord record;
      double first = 0.0;
      for (int k = 0; k < 400 && first == 0.0; ++k) {
        const StylusCommand command = at_tip({x, kHalfEdge + 0.002 - 5e-5 * k, 0.003}, grab);
        simulation.step({&command, 1}, record);
        first = record.stylus[0].force.norm();
      }
      INFO("x " << x << ", grab " << grab << ": first force " << first << " N");
      CHECK(first > 0.0);
      if (grab) CHECK(first < 3.0 * largest + 0.1);
      largest = std::max(largest, first);
    }
  }
}

// What let go inside, as a hold from within reach does, has not come through the surface.
TEST_CASE("touch: no contact begins deeper than the tip can have come in the step", "[slow]") {
  for (const double depth : {0.001, 0.008}) {
    SimulationConfig config = tethered({8}, 0.0, {0.5, 0.5});
    config.styluses[0].reach = 0.01;
    Simulation simulation(config);
    StepRecord record;
    bool touched = false;
    for (int k = 0; k < 200; ++k) {
      const StylusCommand command = at_tip({0.0, kHalfEdge - depth, 0.0}, k < 50);
      simulation.step({&command, 1}, record);
      if (k < 50) REQUIRE(record.stylus[0].contact == ContactState::kHeld);
      if (k < 100) continue;  // it has let go
      touched = touched || record.stylus[0].contact == ContactState::kTouching;
      if (depth > kDeepestStart) REQUIRE(record.stylus[0].force == Vector3::Zero());
    }
    CHECK(touched == (depth < kDeepestStart));
  }
}
