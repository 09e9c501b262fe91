// Objects at rest sleep, and wake as if they had not.
#include <cmath>

#include "simulation/deformation/deformation.hpp"
#include "tests/simulation/touching_cubes.hpp"
#include "tests/support/allocation_guard.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/left_out.hpp"
#include "tests/support/synthetic_model.hpp"

using namespace irdm;
using namespace irdm::test;

namespace {

constexpr double kSleepTime = 0.5;
const Vector3 kAway(0.0, 0.9, 0.0);

// Stiff ones come to rest within half a second.
SimulationConfig sleepers(int count, double youngs_modulus = 1e6) {
  SimulationConfig config =
      stacked(count, {.cells = 3, .youngs_modulus = youngs_modulus}, {0.6, 0.5});
  config.sleep_time = kSleepTime;
  return config;
}

SimulationConfig without_sleep(SimulationConfig config) {
  config.sleep_time = 0.0;
  return config;
}

/// The same scene twice: it may sleep in the first, and never does in the second.
struct Twins {
  explicit Twins(const SimulationConfig& config)
      : may_sleep(config), awake(without_sleep(config)) {}

  void step(const std::optional<Vector3>& tip = std::nullopt) {
    const StylusCommand command = tip ? at_tip(*tip) : StylusCommand{};
    may_sleep.step({&command, 1}, *record);
    awake.step({&command, 1}, *other);
  }
  void step(int steps, const std::optional<Vector3>& tip = std::nullopt) {
    for (int k = 0; k < steps; ++k) step(tip);
  }
  bool all_asleep() const {
    if (record->object_count == 0) return false;  // before the first step
    for (int i = 0; i < record->object_count; ++i) {
      if (!record->object[static_cast<std::size_t>(i)].asleep) return false;
    }
    return true;
  }
  bool any_asleep() const {
    for (int i = 0; i < record->object_count; ++i) {
      if (record->object[static_cast<std::size_t>(i)].asleep) return true;
    }
    return false;
  }
  /// Largest distance of a body from its twin [m].
  double apart() const {
    double most = 0.0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(record->object_count); ++i) {
      most = std::max(most, (record->object[i].position - other->object[i].position).norm());
    }
    return most;
  }

  Simulation may_sleep, awake;
  std::unique_ptr<StepRecord> record = std::make_unique<StepRecord>();
  std::unique_ptr<StepRecord> other = std::make_unique<StepRecord>();
};

double weight_of(const SimulationConfig& config) {
  return config.objects[0].model->body.mass * kGravity;
}

}  // namespace

TEST_CASE("sleep: a stack at rest falls asleep, carries the weights and stays where it is",
          "[slow]") {
  for (const double youngs_modulus : {1e5, 1e6}) {
    const SimulationConfig config = sleepers(3, youngs_modulus);
    Twins twins(config);
    int k = 0;
    for (; k < 5000 && !twins.all_asleep(); ++k) twins.step();
    INFO("E " << youngs_modulus << ": asleep after " << 0.002 * k << " s");
    REQUIRE(twins.all_asleep());
    CHECK(k * 0.002 > kSleepTime);
    const Vector3 there = twins.record->object[2].position;
    twins.step(1500);
    CHECK(twins.all_asleep());
    CHECK(twins.record->object[2].position == there);
    CHECK(twins.record->object[2].velocity == Vector3::Zero());
    CHECK(twins.record->object[2].angular_velocity == Vector3::Zero());
    CHECK(twins.apart() < 1e-5);
    for (int i = 0; i < 3; ++i) {
      const Vector3 force = force_between(*twins.record, i, i - 1);
      const double weight = weight_of(config);
      CHECK((force - Vector3(0, (3 - i) * weight, 0)).norm() < 1e-3 * weight);
    }
  }
}

TEST_CASE("sleep: a stylus wakes the whole stack, and its poke is that of one never asleep",
          "[slow]") {
  Twins twins(sleepers(2));
  twins.step(1000, kAway);
  REQUIRE(twins.all_asleep());
  const double top = twins.record->object[1].position.y() + kHalfEdge;
  double apart = 0.0;
  double off = 0.0;
  double most = 0.0;
  for (int k = 0; k < 1000; ++k) {
    const double depth = 0.002 * std::sin(0.01 * k);
    twins.step(Vector3(0.01, top + 0.0005 - depth, 0.005));
    apart = std::max(apart, twins.apart());
    const Vector3& force = twins.record->stylus[0].force;
    off = std::max(off, (force - twins.other->stylus[0].force).norm());
    most = std::max(most, force.norm());
    if (k > 0) REQUIRE_FALSE(twins.any_asleep());
  }
  INFO("apart " << apart << " m, force off by " << off << " N of " << most << " N");
  CHECK(most > 1.0);
  CHECK(apart < 1e-5);
  CHECK(off < 0.01 * most);
}

TEST_CASE("sleep: what is woken without being touched stays at rest", "[slow]") {
  for (const ResponseKind kind : {ResponseKind::kModal, ResponseKind::kDense}) {
    SimulationConfig config = sleepers(2);
    for (SimulationObject& object : config.objects) {
      object.model = fem_cube({.cells = 3, .youngs_modulus = 1e6, .steps = 300}, kind);
    }
    Twins twins(config);
    twins.step(1000);
    REQUIRE(twins.all_asleep());
    const double top = twins.record->object[1].position.y() + kHalfEdge;
    std::array<Vector3, 2> there;
    for (std::size_t i = 0; i < 2; ++i) there[i] = twins.record->object[i].position;
    double speed = 0.0;
    double moved = 0.0;
    for (int k = 0; k < 200; ++k) {
      twins.step(Vector3(0, top + 0.004, 0));
      REQUIRE_FALSE(twins.any_asleep());
      for (std::size_t i = 0; i < 2; ++i) {
        speed = std::max(speed, twins.record->object[i].velocity.norm());
        moved = std::max(moved, (twins.record->object[i].position - there[i]).norm());
      }
    }
    INFO("moved by " << moved << " m, at most " << speed << " m/s");
    CHECK(speed < 1e-4);
    CHECK(moved < 5e-6);
  }
}

TEST_CASE("sleep: something that comes flying wakes it") {
  SimulationConfig config = sleepers(3);
  config.objects[2].position = Vector3(0.9, kHalfEdge + 0.1, 0.02);
  config.objects[2].velocity = Vector3(-0.5, 0.0, 0);
  config.objects[2].damping = {};
  config.gravity = Vector3::Zero();
  Twins twins(config);
  twins.step(500);
  REQUIRE(twins.record->object[0].asleep);
  REQUIRE(twins.record->object[1].asleep);
  REQUIRE_FALSE(twins.record->object[2].asleep);
  double apart = 0.0;
  for (int k = 0; k < 800; ++k) {
    twins.step();
    apart = std::max(apart, twins.apart());
  }
  INFO("apart " << apart);
  CHECK(twins.record->object[1].velocity.norm() > 0.05);
  CHECK(apart < 1e-5);
}

TEST_CASE("sleep: it wakes when its support is pushed away", "[slow]") {
  SimulationConfig config = sleepers(2);
  config.scenery[0].friction = {0.05, 0.05};
  for (SimulationObject& object : config.objects) object.friction = {0.05, 0.05};
  config.styluses = {{0.0, 2000.0, 0.0}};
  Twins twins(config);
  const Vector3 aside(0.4, 0.05, 0);
  twins.step(1500, aside);
  REQUIRE(twins.all_asleep());
  for (int k = 0; k < 500; ++k) twins.step(aside - Vector3(std::min(0.6, 0.002 * k), 0, 0));
  INFO(twins.record->object[0].position.transpose()
       << ", " << twins.record->object[1].position.transpose());
  CHECK(twins.record->object[0].position.x() < -0.1);
  CHECK(twins.record->object[1].position.y() < 2.5 * kHalfEdge);
}

TEST_CASE("sleep: other settings wake it, the same do not", "[slow]") {
  Twins twins(sleepers(2));
  twins.step(1000);
  REQUIRE(twins.all_asleep());
  Settings settings = twins.may_sleep.settings();
  twins.may_sleep.set(settings);
  twins.step();
  CHECK(twins.all_asleep());
  settings.gravity =
      kGravity * Vector3(std::sin(0.7), -std::cos(0.7), 0);  // above the friction angle
  twins.may_sleep.set(settings);
  twins.awake.set(settings);
  twins.step(100);
  CHECK_FALSE(twins.any_asleep());
  CHECK(twins.record->object[0].velocity.norm() > 0.2);
  CHECK(twins.apart() < 1e-5);
}

TEST_CASE("sleep: a force that comes late, and a reset, wake it", "[slow]") {
  Twins twins(sleepers(2));
  twins.step(1000);
  REQUIRE(twins.all_asleep());
  LateForce late;
  late.object = 1;
  late.age = 3;
  late.point.nodes = {0, 1, 2};
  late.point.weights = {1.0, 0.0, 0.0};
  late.force = Vector3(0, 0.5, 0);
  REQUIRE(twins.may_sleep.insert_delayed_force(late));
  REQUIRE(twins.awake.insert_delayed_force(late));
  twins.step();
  CHECK_FALSE(twins.any_asleep());
  CHECK(twins.apart() < 1e-6);
  twins.step(1500);
  REQUIRE(twins.all_asleep());
  twins.may_sleep.reset();
  twins.awake.reset();
  for (int k = 0; k < 100; ++k) {
    twins.step();
    REQUIRE(twins.apart() == 0.0);
  }
}

TEST_CASE("sleep: what swings elastically alone stays awake until that has decayed") {
  Model model = *fem_cube({.cells = 3, .youngs_modulus = 2e4, .rayleigh_alpha = 2.0});
  model.body.support = Support::kFixed;
  SimulationConfig config;
  config.objects.resize(1);
  config.objects[0].model = std::make_shared<const Model>(std::move(model));
  config.styluses = {{0.0, 500.0, 0.0}};
  config.sleep_time = kSleepTime;
  Twins twins(config);
  twins.step(50, Vector3(0, 0.2, 0));
  for (int k = 0; k <= 50; ++k) twins.step(Vector3(0, kHalfEdge + 0.02 - 0.001 * k, 0));
  Points before;
  twins.may_sleep.object().engine().displacement(before);
  REQUIRE(before.cwiseAbs().maxCoeff() > 1e-3);
  int k = 0;
  for (; k < 10000 && !twins.all_asleep(); ++k) twins.step();
  REQUIRE(twins.all_asleep());
  Points left;
  twins.may_sleep.object().engine().displacement(left);
  INFO("asleep after " << 0.002 * k << " s, with " << left.cwiseAbs().maxCoeff() << " m left");
  CHECK(left.cwiseAbs().maxCoeff() < 1e-5);
}

TEST_CASE("sleep: a world that sleeps and wakes again makes no energy", "[slow]") {
  Twins twins(sleepers(3));
  const auto energy = [&] {
    double sum = 0.0;
    for (int i = 0; i < 3; ++i) {
      const SoftObject& object = twins.may_sleep.object(i);
      FreeForces free;
      free.gravity = Vector3(0, -kGravity, 0);
      sum += rigid_energy(object.rigid(), free, object.state());
    }
    return sum;
  };
  twins.step(1000, kAway);
  const double begun = energy();
  int slept = 0;
  double most = 0.0;
  for (int cycle = 0; cycle < 20; ++cycle) {
    twins.step(3, Vector3(0, 6 * kHalfEdge + 0.004, 0));
    CHECK_FALSE(twins.any_asleep());
    for (int k = 0; k < 400; ++k) {
      twins.step(kAway);
      most = std::max(most, energy() - begun);
    }
    slept += twins.all_asleep() ? 1 : 0;
  }
  INFO(most << " J more, " << energy() - begun << " J in the end");
  CHECK(slept == 20);
  CHECK(most < 1e-6 * begun);
}

TEST_CASE("sleep: what is shown is what the step has, asleep and awake again", "[unsanitized]") {
  const SimulationConfig config = sleepers(2);
  Twins twins(config);
  Deformation deformation(config);
  SurfaceFrame frame = rest_frame(config);
  Points u;
  for (int k = 0; k < 1300; ++k) {
    twins.step(k < 1000 ? kAway : Vector3(0, 4 * kHalfEdge + 0.002 - 1e-5 * (k - 1000), 0));
    deformation.follow(*twins.record);
    if (k == 999) CHECK(twins.all_asleep());
    if (k % 100 != 99) continue;
    deformation.compute(frame);
    for (std::size_t i = 0; i < 2; ++i) {
      twins.may_sleep.object(static_cast<int>(i)).engine().displacement(u);
      CHECK((frame.objects[i].displacement - u).norm() < 1e-12);
    }
  }
}

TEST_CASE("sleep: nothing allocates, and the same commands give the same bits", "[unsanitized]") {
  const SimulationConfig config = sleepers(2);
  Simulation first(config);
  Simulation second(config);
  const auto one = std::make_unique<StepRecord>();
  const auto two = std::make_unique<StepRecord>();
  int slept = 0;
  const AllocationGuard guard;
  for (int k = 0; k < 2500; ++k) {
    const bool near = k > 1000 && k < 1200;
    const StylusCommand command = at_tip(near ? Vector3(0, 4 * kHalfEdge - 0.0005, 0) : kAway);
    first.step({&command, 1}, *one);
    second.step({&command, 1}, *two);
    slept += one->object[0].asleep ? 1 : 0;
    for (std::size_t i = 0; i < 2; ++i) {
      REQUIRE(one->object[i].asleep == two->object[i].asleep);
      REQUIRE(one->object[i].position == two->object[i].position);
      REQUIRE(one->object[i].orientation.coeffs() == two->object[i].orientation.coeffs());
    }
  }
  if (AllocationGuard::active()) CHECK(guard.count() == 0);
  CHECK(slept > 500);
}

TEST_CASE("sleep: never where it is not asked for") {
  Twins twins(without_sleep(sleepers(1)));
  twins.step(1000);
  CHECK_FALSE(twins.any_asleep());
}
