#include "precompute/check/static_reference.hpp"
#include "tests/precompute/discrete.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/fem_cube.hpp"

using namespace irdm;
using namespace irdm::precompute;

namespace {

std::shared_ptr<const Model> cube() {
  return irdm::test::fem_cube({.cells = 2});
}

}  // namespace

TEST_CASE("the static reference is the inertia relief of the mesh, however it is held") {
  const Model& model = *cube();
  TetMesh mesh;
  mesh.nodes = model.mesh.nodes;
  mesh.tets = model.mesh.tets;
  const test::Discrete body(mesh, model.material);
  const int b = 17;
  const int dof = 3 * model.mesh.surface_nodes[b / 3] + b % 3;
  const Eigen::VectorXd u =
      test::inertia_relief(body, Eigen::VectorXd::Unit(3 * mesh.nodes.rows(), dof),
                           test::node_at(mesh, Vector3(-0.06, -0.06, -0.06)),
                           test::node_at(mesh, Vector3(0.06, -0.06, -0.06)),
                           test::node_at(mesh, Vector3(-0.06, 0.06, -0.06)));
  const Eigen::VectorXd found = StaticReference(model).displacement(b);
  double error = 0.0;
  for (std::size_t i = 0; i < model.mesh.surface_nodes.size(); ++i) {
    error = std::max(error, (found.segment<3>(static_cast<Eigen::Index>(3 * i)) -
                             u.segment<3>(3 * model.mesh.surface_nodes[i]))
                                .norm());
  }
  CHECK(error < 1e-9 * u.cwiseAbs().maxCoeff());
}

TEST_CASE("a rigid motion and another elasticity in a column are told apart") {
  const StaticReference reference(*cube());
  const Eigen::VectorXd u = reference.displacement(5);
  const double size = u.cwiseAbs().maxCoeff();
  const Eigen::MatrixXd& rigid = reference.surface_rigid();

  const StaticComparison same = compare_static(u, u, rigid);
  CHECK(same.rigid < 1e-12);
  CHECK(same.mismatch < 1e-12);

  const int motion = GENERATE(0, 1, 2, 3, 4, 5);
  const Eigen::VectorXd moved = rigid.col(motion) / rigid.col(motion).cwiseAbs().maxCoeff();
  const StaticComparison drifting = compare_static(u + 0.05 * size * moved, u, rigid);
  CHECK(drifting.rigid == Approx(0.05));
  CHECK(drifting.mismatch < 1e-12);

  Model stiffer = *cube();
  stiffer.material.youngs_modulus *= 1.25;
  const StaticComparison other = compare_static(StaticReference(stiffer).displacement(5), u, rigid);
  CHECK(other.mismatch > 0.1);
  CHECK(other.mismatch < 0.21);
}
