// Hands: several fingertips that grasp soft cubes by friction alone, lift, turn, hand over and put
// them down.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "simulation/step/simulation.hpp"
#include "tests/simulation/pressed_cube.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/fem_cube.hpp"

using namespace irdm;
using namespace irdm::test;

namespace {

constexpr double kHandFriction = 0.5;

/// Where a fingertip presses on the cube [m], and the outward normal there, both in the hand's
/// frame, which at the start is that of the cube.
struct Finger {
  Vector3 place;
  Vector3 normal;
};
using Hand = std::vector<Finger>;

Finger on_side(const Vector3& normal, const Vector3& aside) {
  return {kHalfEdge * normal + aside, normal};
}

/// Two opposite ones, a thumb against two, a thumb against four.
Hand hand_of(int fingers) {
  const Vector3 right(1, 0, 0);
  if (fingers == 2) return {on_side(right, {0, 0, 0}), on_side(-right, {0, 0, 0})};
  Hand hand{on_side(-right, {0, 0, 0})};
  for (const double z : {-0.02, 0.02}) {
    if (fingers == 3) hand.push_back(on_side(right, {0, 0, z}));
    if (fingers == 3) continue;
    for (const double y : {-0.02, 0.02}) hand.push_back(on_side(right, {0, y, z}));
  }
  return hand;
}

/// Of a hand in one step.
struct Grip {
  Vector3 position = Vector3::Zero();               ///< [m], W
  Quaternion orientation = Quaternion::Identity();  ///< of the hand in W
  double depth = -0.005;                            ///< of all tips inside the faces [m]
};

double ramp(double t, double from, double to) {
  const double s = std::clamp((t - from) / (to - from), 0.0, 1.0);
  return s * s * (3 - 2 * s);
}

void add_tips(const Hand& hand, const Grip& grip, std::vector<StylusCommand>& commands) {
  for (const Finger& finger : hand) {
    const Vector3 tip = finger.place - grip.depth * finger.normal;
    commands.push_back(at_tip(grip.position + grip.orientation * tip));
  }
}

/// Cubes on a table whose top is at y = -kHalfEdge, under gravity.
class World {
 public:
  World(double youngs_modulus, const std::vector<Vector3>& cubes, std::size_t styluses,
        double radius)
      : simulation_(configuration(youngs_modulus, cubes, styluses, radius)) {}

  void step(const std::vector<StylusCommand>& commands) {
    simulation_.step(commands, record_);
    REQUIRE(record_.object[0].solved);
  }
  const ObjectRecord& cube(std::size_t i = 0) const { return record_.object[i]; }
  const StepRecord& record() const { return record_; }
  double weight() const { return kGravity * simulation_.object().model().body.mass; }
  /// The fingers' forces on cubes [N], W.
  Vector3 carried() const {
    Vector3 sum = Vector3::Zero();
    for (int s = 0; s < record_.stylus_count; ++s) {
      sum -= record_.stylus[static_cast<std::size_t>(s)].force;
    }
    return sum;
  }
  /// On cube `object` by cube or scenery `other` [N], W.
  Vector3 between(int object, int other) const {
    Vector3 sum = Vector3::Zero();
    for (const BodyContactRecord& touch : record_.body_contacts()) {
      if (touch.object == object && touch.other == other) sum += touch.force;
      if (touch.object == other && touch.other == object) sum -= touch.force;
    }
    return sum;
  }
  /// Sum of what the fingertips press across the faces of the first cube [N].
  double pressed() const {
    double sum = 0.0;
    for (int s = 0; s < record_.stylus_count; ++s) {
      const ContactRecord& contact = cube().contact[static_cast<std::size_t>(s)];
      if (contact.state != ContactState::kFree) sum -= contact.force.dot(contact.normal);
    }
    return sum;
  }
  /// Where the fingertips touch the first cube at rest [m], B.
  std::vector<Vector3> places() const {
    const RestSurface& rest = simulation_.object().surface();
    std::vector<Vector3> places;
    for (int s = 0; s < record_.stylus_count; ++s) {
      const ContactRecord& contact = cube().contact[static_cast<std::size_t>(s)];
      REQUIRE(contact.state == ContactState::kTouching);
      places.push_back(interpolate(contact.point, [&](int i) { return rest.node(i); }));
    }
    return places;
  }
  /// The steepest force of a fingertip, as a share of what friction allows.
  double steepest() const {
    double most = 0.0;
    for (int s = 0; s < record_.stylus_count; ++s) {
      const ContactRecord& contact = cube().contact[static_cast<std::size_t>(s)];
      const double push = -contact.force.dot(contact.normal);
      most =
          std::max(most, (contact.force + push * contact.normal).norm() / (kHandFriction * push));
    }
    return most;
  }

 private:
  static SimulationConfig configuration(double youngs_modulus, const std::vector<Vector3>& cubes,
                                        std::size_t styluses, double radius) {
    SimulationConfig config;
    config.gravity = Vector3(0, -kGravity, 0);
    for (const Vector3& position : cubes) {
      SimulationObject object;
      object.model = fem_cube({.youngs_modulus = youngs_modulus, .poisson_ratio = 0.45});
      object.friction = {kHandFriction, kHandFriction};
      object.damping = {4.0, 4.0};
      object.position = position;
      config.objects.push_back(object);
    }
    SceneryConfig table;
    table.shape = PlaneShape{};
    table.position = Vector3(0, -kHalfEdge, 0);
    config.scenery.push_back(table);
    config.styluses.assign(styluses, {radius, 0.0, 0.0});
    return config;
  }

  Simulation simulation_;
  StepRecord record_;
};

/// One hand and one cube.
class Grasp {
 public:
  Grasp(double youngs_modulus, int fingers, double radius)
      : hand_(hand_of(fingers)), world_(youngs_modulus, {Vector3::Zero()}, hand_.size(), radius) {}

  World& world() { return world_; }
  Grip& grip() { return grip_; }
  void step() {
    std::vector<StylusCommand> commands;
    add_tips(hand_, grip_, commands);
    world_.step(commands);
  }
  void wait(double seconds) {
    for (int k = 0; k < seconds / 0.002; ++k) step();
  }
  /// Closes to a depth within 1 s, lifts by 5 cm within another one, and comes to rest.
  void lift(double depth) {
    for (int k = 0; k < 1200; ++k) {
      const double t = 0.002 * k;
      grip_.depth = -0.005 + (depth + 0.005) * ramp(t, 0.0, 1.0);
      grip_.position.y() = 0.05 * ramp(t, 1.2, 2.2);
      step();
    }
    wait(2.0);
  }

 private:
  Hand hand_;
  World world_;
  Grip grip_;
};

double largest_way(const std::vector<Vector3>& from, const std::vector<Vector3>& to) {
  double most = 0.0;
  for (std::size_t i = 0; i < from.size(); ++i) most = std::max(most, (to[i] - from[i]).norm());
  return most;
}

// Deep enough for some twice the squeeze that the weight needs.
double depth_for(double youngs_modulus) {
  return youngs_modulus < 10e3 ? 0.02 : youngs_modulus < 30e3 ? 0.01 : 0.005;
}

}  // namespace

TEST_CASE("hands: two, three and five fingertips lift a cube by friction and hold its weight",
          "[slow]") {
  const int fingers = GENERATE(2, 3, 5);
  const double youngs_modulus = GENERATE(5e3, 5e4);
  const double radius = GENERATE(0.005, 0.01);
  CAPTURE(fingers, youngs_modulus, radius);
  Grasp grasp(youngs_modulus, fingers, radius);
  World& world = grasp.world();
  grasp.lift(depth_for(youngs_modulus));
  CHECK(world.between(0, -1).isZero(0.0));
  const std::vector<Vector3> places = world.places();
  const double height = world.cube().position.y();
  for (int k = 0; k < 1000; ++k) {
    grasp.step();
    REQUIRE((world.carried() - Vector3(0, world.weight(), 0)).norm() < 2e-3 * world.weight());
    REQUIRE(world.steepest() < 1.0);
  }
  CHECK(std::abs(world.cube().position.y() - height) < 1e-5);
  CHECK(largest_way(places, world.places()) < 1e-6);  // nothing creeps
}

TEST_CASE("hands: a cube slips when all fingertips together press too little", "[slow]") {
  const int fingers = GENERATE(2, 3, 5);
  const double youngs_modulus = GENERATE(5e3, 5e4);
  CAPTURE(fingers, youngs_modulus);
  Grasp grasp(youngs_modulus, fingers, 0.01);
  World& world = grasp.world();
  grasp.lift(depth_for(youngs_modulus));
  const double threshold = world.weight() / kHandFriction;
  REQUIRE(world.pressed() > 1.1 * threshold);
  double last = world.cube().position.y();
  double pressed = 0.0;
  const double opened = 1e-4 * depth_for(youngs_modulus);  // a step
  while (grasp.grip().depth > 0.0) {
    last = world.cube().position.y();
    pressed = world.pressed();
    grasp.grip().depth -= opened;
    grasp.step();
    if (world.cube().position.y() < last - 1e-5) break;  // 5 mm/s
  }
  INFO("slips at " << pressed / threshold << " of the threshold");
  CHECK(pressed == Approx(threshold).epsilon(0.03));
}

TEST_CASE("hands: a cube turns by 90 degrees with the hand, and the fingertips stay", "[slow]") {
  const int fingers = GENERATE(3, 5);
  const Vector3 axis = GENERATE(Vector3(1, 0, 0), Vector3(0, 0, 1));
  CAPTURE(fingers, axis.transpose());
  Grasp grasp(2e4, fingers, 0.01);
  World& world = grasp.world();
  grasp.lift(0.015);
  const std::vector<Vector3> places = world.places();
  for (int k = 0; k < 1000; ++k) {
    const double angle = M_PI_2 * ramp(0.002 * k, 0.0, 2.0);
    grasp.grip().position.y() = 0.05 + 0.05 * ramp(0.002 * k, 0.0, 2.0);
    grasp.grip().orientation = Quaternion(Eigen::AngleAxisd(angle, axis));
    grasp.step();
    REQUIRE(world.steepest() < 1.001);
  }
  grasp.wait(2.0);
  const double off = grasp.grip().orientation.angularDistance(world.cube().orientation);
  CHECK(off < 1.0 * M_PI / 180);
  CHECK(largest_way(places, world.places()) < 1e-6);
  CHECK((world.carried() - Vector3(0, world.weight(), 0)).norm() < 2e-3 * world.weight());
}

TEST_CASE("hands: handed over, a cube sinks by what the second grip gives under its weight",
          "[slow]") {
  const double youngs_modulus = GENERATE(5e3, 5e4);
  CAPTURE(youngs_modulus);
  const double depth = depth_for(youngs_modulus);
  const Hand first = hand_of(2);
  const Hand second{on_side({0, 0, 1}, {0, 0, 0}), on_side({0, 0, -1}, {0, 0, 0})};
  World world(youngs_modulus, {Vector3::Zero()}, 4, 0.01);
  // The first takes hold and lifts; the second takes hold (3 s), the first lets go (5 s).
  // Height of the cube above the first hand, before that touches it, and in the air [m].
  double taken = 0.0;
  double lifted = 0.0;
  double middle = 0.0;  // of the cube, where the second hand takes it [m]
  for (int k = 0; k < 4500; ++k) {
    const double t = 0.002 * k;
    Grip one, other;
    one.position.y() = 0.05 * ramp(t, 1.2, 2.2);
    one.depth += (depth + 0.005) * (ramp(t, 0.0, 1.0) - ramp(t, 5.0, 6.0));
    other.position.y() = middle;
    other.depth += (depth + 0.005) * ramp(t, 4.0, 5.0);
    std::vector<StylusCommand> commands;
    add_tips(first, one, commands);
    add_tips(second, other, commands);
    world.step(commands);
    if (k == 240) taken = world.cube().position.y();
    if (k != 1990) continue;
    middle = world.cube().position.y();
    lifted = middle - one.position.y();
  }
  const double end = world.cube().position.y() - 0.05;
  const double sag = taken - lifted;
  INFO("sag " << sag << " m, sunk " << lifted - end << " m");
  // The sag also has the strain in it that the table had left between the faces' middles and the
  // cube's.
  CHECK(lifted - end < sag);
  CHECK(lifted - end > 0.7 * sag);
  CHECK((world.carried() - Vector3(0, world.weight(), 0)).norm() < 2e-3 * world.weight());
  CHECK(world.record().stylus[0].force.isZero(0.0));
}

TEST_CASE("hands: a cube is put onto another one, which carries it", "[slow]") {
  Hand hand;  // two against two, which strain the cube alike
  for (const double side : {-1.0, 1.0}) {
    for (const double z : {-0.02, 0.02}) hand.push_back(on_side({side, 0, 0}, {0, 0, z}));
  }
  World world(2e4, {Vector3::Zero(), Vector3(0.2, 0, 0)}, hand.size(), 0.01);
  std::vector<StylusCommand> commands;
  Vector3 held;  // where the hand has it before it lets go [m], W
  for (int k = 0; k < 5000; ++k) {
    const double t = 0.002 * k;
    Grip grip;
    grip.depth += 0.02 * (ramp(t, 0.0, 1.0) - ramp(t, 5.8, 6.5));
    grip.position.y() = 0.14 * ramp(t, 1.2, 2.2) - 0.021 * ramp(t, 4.4, 5.4);
    grip.position.x() = 0.2 * ramp(t, 2.4, 4.2);
    commands.clear();
    add_tips(hand, grip, commands);
    world.step(commands);
    if (k == 2650) held = world.cube().position;
  }
  const double weight = world.weight();
  CHECK(world.carried().isZero(0.0));
  CHECK((world.between(0, 1) - Vector3(0, weight, 0)).norm() < 2e-3 * weight);
  CHECK((world.between(1, -1) - Vector3(0, 2 * weight, 0)).norm() < 4e-3 * weight);
  // It stays where the hand let go, but for what the fingertips had strained.
  CHECK(std::abs(world.cube().position.x() - held.x()) < 1e-3);
  CHECK(held.x() == Approx(0.2).margin(1e-3));
  const Vector3 before = world.cube().position;
  for (int k = 0; k < 1000; ++k) world.step(commands);
  CHECK((world.cube().position - before).norm() < 1e-5);
}

TEST_CASE("hands: ten fingertips hold a cube, their forces and moments balanced", "[slow]") {
  Hand hand;
  for (const double side : {-1.0, 1.0}) {
    for (const double z : {-0.03, 0.0, 0.03}) hand.push_back(on_side({side, 0, 0}, {0, 0, z}));
    for (const double x : {-0.02, 0.02}) hand.push_back(on_side({0, 0, side}, {x, 0, 0}));
  }
  const double radius = GENERATE(0.005, 0.01);
  World world(2e4, {Vector3::Zero()}, hand.size(), radius);
  std::vector<StylusCommand> commands;
  for (int k = 0; k < 2500; ++k) {
    const double t = 0.002 * k;
    Grip grip;
    grip.depth += 0.008 * ramp(t, 0.0, 1.0);
    grip.position.y() = 0.05 * ramp(t, 1.2, 2.2);
    commands.clear();
    add_tips(hand, grip, commands);
    world.step(commands);
  }
  const double weight = world.weight();
  CHECK((world.carried() - Vector3(0, weight, 0)).norm() < 2e-3 * weight);
  CHECK(world.steepest() < 1.0);
  Vector3 moment = Vector3::Zero();
  for (std::size_t i = 0; i < hand.size(); ++i) {
    const Vector3 arm = world.cube().contact[i].proxy - world.cube().position;
    moment -= arm.cross(world.record().stylus[i].force);
  }
  INFO("moment " << moment.transpose() << " N m");
  CHECK(moment.norm() < 1e-3 * weight * kHalfEdge);
  const std::vector<Vector3> places = world.places();
  const Vector3 before = world.cube().position;
  for (int k = 0; k < 1000; ++k) world.step(commands);
  CHECK((world.cube().position - before).norm() < 1e-5);
  CHECK(largest_way(places, world.places()) < 1e-6);
}
