#include "precompute/check/reciprocity.hpp"
#include "tests/check/oscillators.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;
using namespace irdm::precompute;
using irdm::test::damped_modes;
using irdm::test::driving_point;

namespace {

constexpr double kPassiveDt = 0.002;

// Symmetric part of the map from a history of held forces to the displacement increments: the work
// of the history f is f^T A f. Lowest and highest eigenvalue.
Eigen::Vector2d work_range(const DrivingPoint& record, int steps) {
  Eigen::MatrixXd increments = Eigen::MatrixXd::Zero(3 * steps, 3 * steps);
  for (int k = 0; k < steps; ++k) {
    for (int i = 0; i <= k; ++i) {
      const int s = k - i;
      Matrix3 r = Matrix3::Zero();
      if (s < record.cols()) r += record.col(s).reshaped(3, 3);
      if (s >= 1 && s <= record.cols()) r -= record.col(s - 1).reshaped(3, 3);
      increments.block<3, 3>(3 * k, 3 * i) = r;
    }
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(
      0.5 * (increments + increments.transpose()), Eigen::EigenvaluesOnly);
  return {solver.eigenvalues()(0), solver.eigenvalues()(solver.eigenvalues().size() - 1)};
}

}  // namespace

TEST_CASE("damped oscillators give out no energy") {
  CHECK(analyse_passivity(driving_point(damped_modes(), kPassiveDt, 1000), 1.0).lowest > -1e-6);
}

TEST_CASE("an oscillator that grows gives out energy") {
  auto modes = damped_modes();
  modes[1].sigma = -2.0;
  const Passivity found = analyse_passivity(driving_point(modes, kPassiveDt, 500), 1.0);
  CHECK(found.lowest < -0.01);
  CHECK(found.angle / kPassiveDt == Approx(modes[1].omega).epsilon(0.1));
}

TEST_CASE("a record that is cut off while it rings gives out energy") {
  CHECK(analyse_passivity(driving_point(damped_modes(), kPassiveDt, 60), 1.0).lowest < -0.01);
}

TEST_CASE("what is lowest on the circle is the least work of all histories of force") {
  auto modes = damped_modes();
  modes[2].sigma = -1.0;
  const DrivingPoint record = driving_point(modes, kPassiveDt, 60);
  const Passivity found = analyse_passivity(record, 1.0);
  // The eigenvalues of the truncated Toeplitz matrices approach the range on the circle from
  // within.
  const Eigen::Vector2d short_history = work_range(record, 80);
  const Eigen::Vector2d history = work_range(record, 320);
  const double gap = history(0) / history(1) - found.lowest;
  const double short_gap = short_history(0) / short_history(1) - found.lowest;
  CHECK(gap > 0.0);
  CHECK(gap < 0.25 * short_gap);  // second order in the length
  CHECK(gap < 0.1 * std::abs(found.lowest));
}

TEST_CASE("a response that is not reciprocal can be active though its symmetric part is passive") {
  DrivingPoint record = driving_point(damped_modes(), kPassiveDt, 1000);
  Matrix3 turn = Matrix3::Zero();
  turn(0, 1) = 2e-4;
  turn(1, 0) = -2e-4;
  for (int s = 0; s < 20; ++s) record.col(s) += turn.reshaped();
  CHECK(analyse_passivity(record, 1.0).lowest < -0.01);
}
