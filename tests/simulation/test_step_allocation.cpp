#include <cmath>

#include "simulation/step/simulation.hpp"
#include "tests/support/allocation_guard.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/fem_cube.hpp"
#include "tests/support/left_out.hpp"
#include "tests/support/synthetic_model.hpp"

using namespace irdm;
using namespace irdm::test;

TEST_CASE(
    "step: nothing allocates, free, touching, held or reset, with two styluses and all "
    "engines, with and without inertial loading",
    "[unsanitized]") {
  if (!AllocationGuard::active()) return leave_out(kNotCounted);
  const bool rigid = GENERATE(false, true);
  const ResponseKind kind =
      GENERATE(ResponseKind::kModal, ResponseKind::kDense, ResponseKind::kCompressed);
  if (rigid && kind != ResponseKind::kModal) return;
  SimulationConfig config;
  config.objects.resize(1);
  config.objects[0].model = fem_cube({3, 2000.0, 8.0, 0.002, 200}, kind);
  if (rigid) {
    config.objects[0].model = std::make_shared<const Model>(made_rigid(*config.objects[0].model));
  }
  config.objects[0].friction = {0.6, 0.5};
  config.objects[0].inertial_loading =
      GENERATE(false, true) && !rigid && kind != ResponseKind::kCompressed;
  config.objects[0].angular_velocity = Vector3(0.1, 0.2, 0.3);
  config.styluses = {{0.0, 0.0, 0.0}, {0.015, 1000.0, 0.005}};
  Simulation simulation(config);
  StepRecord record;
  int touching = 0;
  int held = 0;
  int resets = 0;
  // No warm-up: the first step must not allocate either.
  const AllocationGuard guard;
  for (int k = 0; k < 1000; ++k) {
    const double t = 0.002 * k;
    const double depth = 0.004 * std::sin(12.0 * t);
    const std::array<StylusCommand, 2> commands{
        StylusCommand{
            true, std::sin(3.0 * t) > 0 ? kGrabButton : 0u, {0.001, 0.061 - depth, 0.0}, {}},
        StylusCommand{k % 500 < 400, 0u, {0.061 - depth, 0.01, 0.002}, {}}};
    simulation.step(commands, record, k % 300 == 299);
    resets += record.reset ? 1 : 0;
    for (const StylusRecord& stylus : record.stylus) {
      touching += stylus.contact == ContactState::kTouching ? 1 : 0;
      held += stylus.contact == ContactState::kHeld ? 1 : 0;
    }
  }
  CHECK(guard.count() == 0);
  CHECK(touching > 20);
  CHECK(held > 20);
  CHECK(resets == 3);
}
