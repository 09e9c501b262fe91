// A run that is rerun by another engine, whose error is known.
#include <numbers>

#include "replay/rerun/deviation.hpp"
#include "replay/rerun/rerun.hpp"
#include "tests/replay/kept_run.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/fem_cube.hpp"

using namespace irdm;
using namespace irdm::replay;
using namespace irdm::test;

namespace {

// So much damping that little is left of a response after its 0.4 s: exp(-30 / s * 0.4 s) = 6e-6.
constexpr FemCube kCube{.cells = 3, .rayleigh_alpha = 60.0, .steps = 200, .poisson_ratio = 0.45};

SimulationConfig scene(ResponseKind kind) {
  SimulationConfig config;
  config.objects.resize(1);
  config.objects[0].model = fem_cube(kCube, kind);
  config.objects[0].friction = {0.6, 0.5};
  config.styluses = {{0.0, 2000.0, 0.0}};
  return config;
}

// Presses, takes hold and swings.
KeptRun swing() {
  KeptRun run(scene(ResponseKind::kModal));
  Simulation simulation(run.config);
  StepRecord record;
  for (int k = 0; k < 600; ++k) {
    const double phase = 2.0 * std::numbers::pi * 1.5 * 0.002 * std::max(k - 100, 0);
    const Vector3 tip(0.01 + 0.03 * std::sin(phase), 0.061 - std::min(1e-4 * k, 0.008), 0.01);
    const std::array<StylusCommand, 1> commands{
        StylusCommand{true, k > 90 ? kGrabButton : 0, tip, {}}};
    simulation.step(commands, record);
    run.keep(simulation, record);
  }
  return run;
}

struct Errors {
  Deviation deviation;
  double displacement = 0.0;  ///< as a share of the largest
};

Errors errors_of_rerun(Rerun& made, const KeptRun& run) {
  const Recording recording = run.recording();
  Errors errors;
  double largest = 0.0;
  StepRecord recorded;
  StepRecord again;
  Points u;
  for (std::size_t k = 0; k < recording.steps(); ++k) {
    recording.step(k, recorded);
    made.step(recorded, again);
    made.displacement(0, u);
    errors.deviation.add(run.records[k], again);
    errors.displacement =
        std::max(errors.displacement, (u - run.displacements[k][0]).cwiseAbs().maxCoeff());
    largest = std::max(largest, run.displacements[k][0].cwiseAbs().maxCoeff());
  }
  REQUIRE(largest > 1e-3);
  errors.displacement /= largest;
  return errors;
}

}  // namespace

TEST_CASE("dense makes a run of modal again within the end of its responses and rounding",
          "[slow]") {
  const KeptRun run = swing();
  const SimulationConfig dense = scene(ResponseKind::kDense);
  InputRerun from_inputs(dense);
  ForceRerun from_forces(dense);
  Rerun& made = GENERATE(true, false) ? static_cast<Rerun&>(from_inputs) : from_forces;
  const Errors errors = errors_of_rerun(made, run);
  INFO(errors.deviation.text() << "displacement " << errors.displacement);
  CHECK(errors.deviation.peak_force() > 0.2);
  CHECK(errors.deviation.force() < 1e-5 * errors.deviation.peak_force());
  CHECK(errors.displacement < 1e-5);
  CHECK(errors.deviation.other_contacts() == 0);
}

TEST_CASE("a compressed response makes a run again within its error", "[slow]") {
  const KeptRun run = swing();
  const SimulationConfig compressed = scene(ResponseKind::kCompressed);
  ForceRerun made(compressed);
  const Errors errors = errors_of_rerun(made, run);
  INFO(errors.deviation.text() << "displacement " << errors.displacement);
  CHECK(errors.displacement < 0.05);  // what fem_cube() asks for
  CHECK(errors.displacement > 1e-7);  // and it is another engine
}
