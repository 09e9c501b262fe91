// Objects of which not all modes are there: both engines, the whole step, and what a finger feels
// against the full set.
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "common/response/stored_response.hpp"
#include "simulation/engine/response_engine.hpp"
#include "tests/simulation/pressed_cube.hpp"
#include "tests/support/allocation_guard.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/left_out.hpp"
#include "tests/support/shared_model.hpp"
#include "tests/support/synthetic_model.hpp"

using namespace irdm;
using namespace irdm::test;

namespace {

Model with_residual(int modes = 20) {
  Model model = synthetic_cube(3, modes, 200);
  add_residual(model);
  return model;
}

std::vector<NodalForce> forces_of_step(int k) {
  if (k % 7 == 6) return {};
  return {{k % 5, Vector3(0.1 * k, -1.0, 0.3)},
          {(k + 1) % 5, Vector3(0.2, 0.5, -0.01 * k)},
          {k % 5, Vector3(0.0, 0.0, 0.25)}};
}

// Largest force on the stylus and largest difference to another run's, over a press of 1 cm.
std::vector<Vector3> pressed_forces(const FemCube& cube, double x, double z) {
  Simulation simulation(tethered(cube, 0.015, {0.5, 0.5}));
  StepRecord record;
  std::vector<Vector3> forces;
  for (int k = 0; k < 500; ++k) {
    const StylusCommand command = at_tip(press(0.002 * (k + 1), 0.01, x, z));
    simulation.step({&command, 1}, record);
    forces.push_back(record.stylus[0].force);
  }
  return forces;
}

/// What two runs of the same press differ by, as shares of the largest force.
struct StepwiseDifference {
  double step = 0.0;         ///< of a step
  double mean = 0.0;         ///< without what goes to and fro from step to step (binomial, 5 steps)
  double alternation = 0.0;  ///< by which the first run's force goes to and fro from step to step
};

StepwiseDifference force_difference(const FemCube& all, const FemCube& some, double x, double z) {
  const std::vector<Vector3> expected = pressed_forces(all, x, z);
  const std::vector<Vector3> found = pressed_forces(some, x, z);
  double peak = 0.0;
  for (const Vector3& force : expected) peak = std::max(peak, force.norm());
  REQUIRE(peak > 0.1);
  StepwiseDifference worst;
  const auto difference = [&](std::size_t k) -> Vector3 { return found[k] - expected[k]; };
  for (std::size_t k = 2; k + 2 < expected.size(); ++k) {
    const Vector3 mean = (difference(k - 2) + 4.0 * difference(k - 1) + 6.0 * difference(k) +
                          4.0 * difference(k + 1) + difference(k + 2)) /
                         16.0;
    const Vector3 fro = (expected[k - 1] - 2.0 * expected[k] + expected[k + 1]) / 4.0;
    worst.step = std::max(worst.step, difference(k).norm() / peak);
    worst.mean = std::max(worst.mean, mean.norm() / peak);
    worst.alternation = std::max(worst.alternation, fro.norm() / peak);
  }
  return worst;
}

}  // namespace

TEST_CASE("reduced modes: the engine answers as R does that the model stands for", "[slow]") {
  const int modes = GENERATE(20, 1100);  // the engine takes 512 at a time
  CAPTURE(modes);
  const Model model = with_residual(modes);
  const auto modal = make_engine(share(model));
  const Model whole = with_dense_response<double>(model);
  const auto dense = make_engine(share(whole));
  const std::array<ContactPatch, 3> patches{
      ContactPatch(SurfacePoint{{0, 1, 2}, {0.2, 0.3, 0.5}}),
      ContactPatch(SurfacePoint{{3, 7, 9}, {1.0, 0.0, 0.0}}),
      ContactPatch(SurfacePoint{{2, 3, 4}, {0.5, 0.25, 0.25}})};
  std::array<Vector3, 3> h, expected_h;
  ContactMatrix W, expected_W;
  std::array<Vector3, 12> path, expected_path;
  std::array<Matrix3, 12> response, expected_response;
  Points u, expected_u;
  for (int k = 0; k < 60; ++k) {
    const auto forces = forces_of_step(k);
    modal->predict(patches, h, W);
    dense->predict(patches, expected_h, expected_W);
    REQUIRE((W - expected_W).norm() < 1e-10 * expected_W.norm());
    modal->advance(forces);
    dense->advance(forces);
    if (k % 4 == 3) {
      for (const int age : {0, 2}) {
        modal->add_delayed_force(forces_of_step(k + 1), age);
        dense->add_delayed_force(forces_of_step(k + 1), age);
      }
    }
    modal->displacement(u);
    dense->displacement(expected_u);
    const double scale = expected_u.cwiseAbs().maxCoeff();
    REQUIRE((u - expected_u).cwiseAbs().maxCoeff() <= 1e-10 * scale);
    REQUIRE((modal->free_displacement(3) - dense->free_displacement(3)).norm() <= 1e-10 * scale);
    modal->predict_horizon(patches[0], forces, path, response);
    dense->predict_horizon(patches[0], forces, expected_path, expected_response);
    for (std::size_t n = 0; n < path.size(); ++n) {
      constexpr double kSingle = 1e-6;  // what tables in single precision may cost
      const double precision = n == 0 ? 1e-10 : kSingle;
      REQUIRE((path[n] - expected_path[n]).norm() <= kSingle * (scale + expected_path[n].norm()));
      REQUIRE((response[n] - expected_response[n]).norm() <=
              precision * expected_response[0].norm());
    }
  }
  // What the bridge is told of the first step is what the step itself uses.
  CHECK((response[0] - W.topLeftCorner<3, 3>()).norm() < 1e-12 * response[0].norm());
  const Eigen::MatrixXd R = stored_response(whole)->zero_lag();
  CHECK((stored_response(model)->zero_lag() - R).norm() < 1e-10 * R.norm());
  modal->reset();
  modal->displacement(u);
  CHECK(u.isZero(0.0));
}

TEST_CASE("reduced modes: the surface is the same bits with any number of threads") {
  const auto engine = make_engine(share(with_residual()));
  for (int k = 0; k < 5; ++k) engine->advance(forces_of_step(k));
  Points one, many;
  const int before = omp_get_max_threads();
  omp_set_num_threads(1);
  engine->displacement(one);
  omp_set_num_threads(3);
  engine->displacement(many);
  omp_set_num_threads(before);
  CHECK(one == many);
}

TEST_CASE("reduced modes: nothing allocates in a step") {
  if (!AllocationGuard::active()) return leave_out(kNotCounted);
  SimulationConfig config = tethered({4, 2000.0, 8.0, 0.002, 200, 0.4, 1, 40}, 0.015, {0.5, 0.4});
  Simulation simulation(config);
  StepRecord record;
  int touching = 0;
  const AllocationGuard guard;
  for (int k = 0; k < 500; ++k) {
    const StylusCommand command =
        at_tip(press(0.004 * (k + 1), 0.008, 0.01 * std::sin(0.02 * k), 0.004), k > 400);
    simulation.step({&command, 1}, record, k == 490);
    touching += record.stylus[0].contact != ContactState::kFree ? 1 : 0;
  }
  CHECK(guard.count() == 0);
  CHECK(touching > 100);
}

TEST_CASE(
    "reduced modes: a fingertip that presses feels the force that the file says, about 1 % off",
    "[slow]") {
  FemCube all;
  all.cells = 8;
  all.poisson_ratio = 0.4;
  FemCube some = all;
  some.modes = 200;
  const StepwiseDifference difference = force_difference(all, some, 0.003, 0.004);
  std::cout << "200 of " << std::get<ModalResponse>(fem_cube(all)->response).mode_count()
            << " modes: force off by " << difference.step << "\n";
  const double stated =
      std::get<ModalResponse>(fem_cube(some)->response).residual.reduction.force_error;
  CHECK(stated < 0.015);
  CHECK(difference.step < 1.5 * stated);  // another place and speed than the samples'
}

// At edges and corners, where little mass is under the finger, the force of *all* modes goes to and
// fro from step to step: the step's inverse has a pole near -1 there, which the few modes do not.
TEST_CASE("reduced modes: the same on a finer mesh, in the middle, at an edge and at a corner",
          "[exhaustive]") {
  FemCube all;
  all.cells = 12;
  all.poisson_ratio = 0.4;
  FemCube some = all;
  some.modes = 600;
  for (const double x : {0.003, 0.05}) {
    for (const double z : {0.004, 0.05}) {
      const StepwiseDifference difference = force_difference(all, some, x, z);
      std::cout << some.modes << " of "
                << std::get<ModalResponse>(fem_cube(all)->response).mode_count() << " modes, at "
                << x << ", " << z << ": force off by " << difference.step << ", in the mean by "
                << difference.mean << "; goes to and fro by " << difference.alternation << "\n";
      CHECK(difference.mean < 0.01);
      CHECK(difference.step < 0.01 + difference.alternation);
    }
  }
}
