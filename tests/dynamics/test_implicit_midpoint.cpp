#include <cmath>

#include "precompute/dynamics/implicit_midpoint.hpp"
#include "tests/precompute/meshes.hpp"
#include "tests/support/catch.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::precompute;

namespace {

const TetMesh& small_box() {
  static const TetMesh mesh = test::box_mesh(Vector3(0.12, 0.08, 0.10), {3, 2, 2});
  return mesh;
}

SoftBody body(Elasticity elasticity, double alpha, double beta) {
  return {small_box(), {2000.0, 0.3, 110.0, alpha, beta}, elasticity};
}

// Spinning at 10 rad/s, flying, stretched by a fifth along x and sheared.
BodyState thrown(const SoftBody& b) {
  Matrix3 stretch;
  stretch << 1.2, 0.05, 0, 0.1, 0.95, 0, 0, 0, 0.9;
  const Points x = b.rest() * stretch.transpose();
  const Points v =
      (x * skew(Vector3(6, -7, 4)).transpose()).rowwise() + Eigen::RowVector3d(0.5, 0.2, -0.1);
  return {(x - b.rest()).reshaped<Eigen::RowMajor>(), v.reshaped<Eigen::RowMajor>()};
}

double energy(const SoftBody& b, const BodyState& s) {
  return b.elastic_energy(s.u) + b.kinetic_energy(s.v);
}

}  // namespace

namespace {

struct Flight {
  double momentum_error = 0.0;  // relative
  double angular_error = 0.0;   // relative
  double largest_gain = -1.0;   // of energy over the first, relative
  double largest_loss = -1.0;
};

// One second of free flight.
Flight fly(const SoftBody& b, double h) {
  ImplicitMidpoint stepper(b, 1e-12);
  stepper.prepare(h);
  BodyState state = thrown(b);
  const Vector3 momentum = b.momentum(state.v);
  const Vector3 angular = b.angular_momentum(state);
  const double first = energy(b, state);
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(state.u.size());
  ImplicitMidpoint::Workspace workspace;
  Flight flight;
  for (int k = 0; k < std::lround(1.0 / h); ++k) {
    stepper.step(state, none, h, workspace);
    const double gain = energy(b, state) / first - 1.0;
    flight.largest_gain = std::max(flight.largest_gain, gain);
    flight.largest_loss = std::max(flight.largest_loss, -gain);
  }
  flight.momentum_error = (b.momentum(state.v) - momentum).norm() / momentum.norm();
  flight.angular_error = (b.angular_momentum(state) - angular).norm() / angular.norm();
  return flight;
}

}  // namespace

TEST_CASE("damped corotational free flight conserves both momenta and gains no energy") {
  const Flight flight = fly(body(Elasticity::kCorotational, 8.0, 2e-4), 0.001);
  CHECK(flight.momentum_error < 1e-12);
  CHECK(flight.angular_error < 1e-11);
  CHECK(flight.largest_gain < 0.0);
}

// To the tolerance that each step is solved to (1e-12 of the velocity), added up over the steps.
TEST_CASE("undamped corotational flight conserves both momenta and the energy, at any step",
          "[slow]") {
  const SoftBody b = body(Elasticity::kCorotational, 0.0, 0.0);
  for (const double h : {0.004, 0.002, 0.001, 0.0005}) {
    CAPTURE(h);
    const Flight flight = fly(b, h);
    CHECK(flight.momentum_error < 1e-12);
    CHECK(flight.angular_error < 1e-11);
    CHECK(flight.largest_gain < 1e-11);
    CHECK(flight.largest_loss < 1e-11);
  }
}

TEST_CASE("neo-Hookean free flight conserves both momenta and the energy, or gains none damped") {
  const Flight undamped = fly(body(Elasticity::kNeoHookean, 0.0, 0.0), 0.002);
  CHECK(undamped.momentum_error < 1e-12);
  CHECK(undamped.angular_error < 1e-11);
  CHECK(undamped.largest_gain < 1e-10);
  CHECK(undamped.largest_loss < 1e-10);
  const Flight damped = fly(body(Elasticity::kNeoHookean, 8.0, 2e-4), 0.002);
  CHECK(damped.momentum_error < 1e-12);
  CHECK(damped.angular_error < 1e-11);
  CHECK(damped.largest_gain < 0.0);
}

TEST_CASE("a corotational flight converges with the square of the step, damped or not") {
  for (const auto& [alpha, beta] : {std::pair(0.0, 0.0), std::pair(8.0, 2e-4)}) {
    const SoftBody b = body(Elasticity::kCorotational, alpha, beta);
    const auto end = [&](double h) {
      ImplicitMidpoint stepper(b, 1e-12);
      stepper.prepare(h);
      BodyState state = thrown(b);
      ImplicitMidpoint::Workspace workspace;
      const Eigen::VectorXd none = Eigen::VectorXd::Zero(state.u.size());
      for (int k = 0; k < std::lround(0.02 / h); ++k) stepper.step(state, none, h, workspace);
      return state.u;
    };
    const Eigen::VectorXd u1 = end(2e-4);
    const Eigen::VectorXd u2 = end(1e-4);
    const Eigen::VectorXd u4 = end(5e-5);
    const Eigen::VectorXd u8 = end(2.5e-5);
    CAPTURE(alpha, (u1 - u2).norm(), (u2 - u4).norm(), (u4 - u8).norm());
    CHECK((u1 - u2).norm() / (u2 - u4).norm() == Approx(4.0).epsilon(0.1));
    CHECK((u2 - u4).norm() / (u4 - u8).norm() == Approx(4.0).epsilon(0.05));
  }
}

TEST_CASE("linear energy is conserved exactly, for steps far beyond the fastest period") {
  const SoftBody b = body(Elasticity::kLinear, 0.0, 0.0);
  ImplicitMidpoint stepper(b);
  stepper.prepare(0.1);
  BodyState state = b.at_rest();
  std::srand(1);
  state.v = Eigen::VectorXd::Random(state.v.size());
  const double first = energy(b, state);
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(state.u.size());
  ImplicitMidpoint::Workspace workspace;
  for (int k = 0; k < 200; ++k) stepper.step(state, none, 0.1, workspace);
  CHECK(energy(b, state) == Approx(first).epsilon(1e-9));
  CHECK(workspace.solutions == 200);
}

TEST_CASE("mass-proportional damping does not slow a body in flight") {
  for (const auto elasticity : {Elasticity::kLinear, Elasticity::kCorotational}) {
    const SoftBody b = body(elasticity, 8.0, 2e-4);
    ImplicitMidpoint stepper(b);
    stepper.prepare(0.002);
    BodyState state = b.at_rest();
    state.v = Eigen::RowVector3d(0.5, 0.2, -0.1).transpose().replicate(b.node_count(), 1);
    const Eigen::VectorXd velocity = state.v;
    ImplicitMidpoint::Workspace workspace;
    for (int k = 0; k < 500; ++k) {
      stepper.step(state, Eigen::VectorXd::Zero(state.u.size()), 0.002, workspace);
    }
    CHECK((state.v - velocity).norm() < 1e-9 * velocity.norm());
    CHECK((state.u - velocity).norm() < 1e-9 * velocity.norm());
  }
}

TEST_CASE("a held force accelerates the body as a whole like a rigid one") {
  const SoftBody b = body(Elasticity::kCorotational, 8.0, 2e-4);
  ImplicitMidpoint stepper(b);
  stepper.prepare(0.002);
  BodyState state = b.at_rest();
  Eigen::VectorXd force = Eigen::VectorXd::Zero(state.u.size());
  force.segment<3>(0) = Vector3(0.02, -0.01, 0.005);
  ImplicitMidpoint::Workspace workspace;
  for (int k = 0; k < 100; ++k) stepper.step(state, force, 0.002, workspace);
  const Vector3 expected = 0.2 * force.segment<3>(0);
  CHECK((b.momentum(state.v) - expected).norm() < 1e-9 * expected.norm());
}

TEST_CASE("a step that cannot be solved is told") {
  const SoftBody b = body(Elasticity::kCorotational, 0.0, 0.0);
  ImplicitMidpoint stepper(b);
  stepper.prepare(0.1);
  BodyState state = b.at_rest();
  state.v.setConstant(std::numeric_limits<double>::quiet_NaN());
  ImplicitMidpoint::Workspace workspace;
  CHECK_THROWS_WITH(stepper.step(state, Eigen::VectorXd::Zero(state.u.size()), 0.1, workspace),
                    ContainsSubstring("cannot be solved"));
}

TEST_CASE("a body at rest anywhere stays there: what rounding its positions moves is no motion") {
  const TetMesh mesh = test::box_mesh(Vector3(0.12, 0.12, 0.12), {6, 6, 6});
  const Matrix3 turn = Eigen::AngleAxisd(0.7, Vector3(1, 2, 3).normalized()).toRotationMatrix();
  const double away = GENERATE(0.0, 0.1, 10.0);
  const double youngs_modulus = GENERATE(2e3, 1e6);
  const double h = GENERATE(5e-4, 0.01);
  CAPTURE(away, youngs_modulus, h);
  const SoftBody b(mesh, {youngs_modulus, 0.49, 110.0, 8.0, 2e-4}, Elasticity::kCorotational);
  ImplicitMidpoint stepper(b, 1e-9);
  stepper.prepare(h);
  const Points x = (b.rest() * turn.transpose()).rowwise() + Eigen::RowVector3d(away, 0.02, 0.0);
  BodyState state = b.at_rest();
  state.u = (x - b.rest()).reshaped<Eigen::RowMajor>();
  const Eigen::VectorXd start = state.u;
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(start.size());
  ImplicitMidpoint::Workspace workspace;
  constexpr int kSteps = 20;
  for (int k = 0; k < kSteps; ++k) stepper.step(state, none, h, workspace);
  CHECK((state.u - start).cwiseAbs().maxCoeff() < kSteps * 1e-15 * (1.0 + away));
}
