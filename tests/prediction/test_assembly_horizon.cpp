#include <cmath>

#include "simulation/step/simulation.hpp"
#include "tests/support/allocation_guard.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/fem_cube.hpp"
#include "tests/support/left_out.hpp"

// What a bridge is told of its contact has the other contacts in it as they answer: the same as the
// simulation does when it goes on with them.

using namespace irdm;
using namespace irdm::test;

namespace {

constexpr int kHorizon = 25;
constexpr double kHalf = 0.06;

enum class Other { kHolds, kPresses };

/// A free cube, held at its left side by the first stylus; the second holds or presses its right
/// side.
struct Scene {
  Scene(ResponseKind kind, double youngs_modulus, Other other)
      : simulation(config(kind, youngs_modulus)), presses(other == Other::kPresses) {
    for (int k = 0; k < 200; ++k) {
      const double in = presses ? 0.004 * std::min(1.0, k / 100.0) : 0.0;
      simulation.step(std::array{command(-kHalf, true), command(kHalf + 0.001 - in, !presses)},
                      record);
    }
    simulation.predict_horizon(0, Vector3(-kHalf, 0, 0), kHorizon, model);
  }

  static SimulationConfig config(ResponseKind kind, double youngs_modulus) {
    SimulationConfig config;
    config.objects.resize(1);
    config.objects[0].model =
        fem_cube({.cells = 2, .youngs_modulus = youngs_modulus, .steps = 300}, kind);
    config.objects[0].friction = {0.6, 0.5};
    config.styluses = {{0.0, 1000.0, 0.005}, {0.0, 1000.0, 0.005}};
    return config;
  }
  static StylusCommand command(double x, bool grab) {
    return {true, grab ? kGrabButton : 0u, Vector3(x, 0, 0), {}};
  }

  Simulation simulation;
  bool presses;
  StepRecord record;
  ContactModel model;
};

/// The place of the contact by the model at the end of each step, under these forces [m], W.
std::vector<Vector3> predicted(const ContactModel& model, const std::vector<Vector3>& forces) {
  const RigidBody body(model.body, model.dt);
  RigidState motion = model.motion;
  std::vector<Vector3> places;
  std::vector<Vector3> forces_B;
  for (std::size_t n = 0; n < forces.size(); ++n) {
    const FreeMotion free = free_motion(body, model.free_forces, motion);
    forces_B.push_back(free.halfway.conjugate() * forces[n]);
    Vector3 place = model.place + model.path[n];
    const Vector3 torque = model.other_torque + place.cross(forces_B[n]);
    motion = end_of_step(body, model.free_forces, free,
                         free.halfway * (model.other_force + forces_B[n]), free.halfway * torque);
    for (std::size_t i = 0; i <= n; ++i) place += model.response[n - i] * forces_B[i];
    places.push_back(motion.position + motion.orientation * place);
  }
  return places;
}

/// The largest way of the contact from where it was, and the largest error of the prediction [m].
std::array<double, 2> compare(Scene& scene) {
  const Vector3 now = -scene.record.stylus[0].force;
  std::vector<Vector3> forces;
  for (int n = 0; n < kHorizon; ++n) {
    forces.push_back(now + Vector3(0.3 * std::sin(0.4 * n), 0.05 * std::cos(0.3 * n), 0.02));
  }
  const std::vector<Vector3> told = predicted(scene.model, forces);
  const Vector3 before = scene.record.object[0].contact[0].proxy;
  std::array<double, 2> found{};
  const double right = kHalf + 0.001 - (scene.presses ? 0.004 : 0.0);
  for (std::size_t n = 0; n < kHorizon; ++n) {
    StylusCommand ours = Scene::command(-kHalf, true);
    ours.bridged = BridgedForce{forces[n], scene.model.place + scene.model.path[n], 0};
    scene.simulation.step(std::array{ours, Scene::command(right, !scene.presses)}, scene.record);
    const Vector3 place = scene.record.object[0].contact[0].proxy;
    found[0] = std::max(found[0], (place - before).norm());
    found[1] = std::max(found[1], (place - told[n]).norm());
  }
  return found;
}

}  // namespace

TEST_CASE("assembly: a contact among others goes as the simulation goes on", "[slow]") {
  for (const ResponseKind kind :
       {ResponseKind::kModal, ResponseKind::kDense, ResponseKind::kCompressed}) {
    for (const double E : {2e3, 2e4, 2e5}) {
      for (const Other other : {Other::kHolds, Other::kPresses}) {
        Scene scene(kind, E, other);
        CAPTURE(static_cast<int>(kind), E, static_cast<int>(other));
        REQUIRE(scene.model.valid);
        REQUIRE(scene.model.state == ContactState::kHeld);
        CHECK(check(scene.model) == ContactModelFault::kNone);
        const auto [way, error] = compare(scene);
        CHECK(way > 1e-4);
        CHECK(error / way < 0.02);
      }
    }
  }
}

TEST_CASE("assembly: a model with another contact in it allocates nothing") {
  if (!AllocationGuard::active()) return leave_out(kNotCounted);
  for (const ResponseKind kind :
       {ResponseKind::kModal, ResponseKind::kDense, ResponseKind::kCompressed}) {
    Scene scene(kind, 2e4, Other::kPresses);
    const AllocationGuard guard;
    for (int k = 0; k < 10; ++k) {
      scene.simulation.step(std::array{Scene::command(-kHalf, true), Scene::command(0.057, false)},
                            scene.record);
      scene.simulation.predict_horizon(0, Vector3(-kHalf, 0, 0), kHorizon, scene.model);
    }
    CHECK(guard.count() == 0);
  }
}
