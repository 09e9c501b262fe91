#include "precompute/dynamics/implicit_midpoint.hpp"
#include "tests/precompute/meshes.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;
using namespace irdm::precompute;

TEST_CASE("several linear trajectories at once are those of one at a time") {
  const SoftBody body(test::box_mesh(Vector3(0.12, 0.08, 0.10), {3, 2, 2}),
                      {2000.0, 0.3, 110.0, 8.0, 2e-4}, Elasticity::kLinear);
  const double h = 0.001;
  std::srand(1);
  const Eigen::MatrixXd force = 0.01 * Eigen::MatrixXd::Random(body.rest().size(), 3);
  Eigen::MatrixXd u = Eigen::MatrixXd::Zero(force.rows(), 3);
  Eigen::MatrixXd v = 0.1 * Eigen::MatrixXd::Random(force.rows(), 3);
  const Eigen::MatrixXd first = v;
  LinearMidpoint together(body);
  together.prepare(h);
  for (int k = 0; k < 100; ++k) together.step(u, v, force, h);

  ImplicitMidpoint alone(body);
  alone.prepare(h);
  for (int m = 0; m < 3; ++m) {
    BodyState state{Eigen::VectorXd::Zero(force.rows()), first.col(m)};
    ImplicitMidpoint::Workspace workspace;
    for (int k = 0; k < 100; ++k) alone.step(state, force.col(m), h, workspace);
    CHECK((state.u - u.col(m)).norm() < 1e-11 * u.col(m).norm());
    CHECK((state.v - v.col(m)).norm() < 1e-11 * v.col(m).norm());
  }
}
