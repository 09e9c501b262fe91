#include "tests/support/static_cube.hpp"

#include "precompute/fem/assembly.hpp"
#include "precompute/fem/mass_properties.hpp"
#include "precompute/fem/rigid_motions.hpp"
#include "precompute/mesh/box_mesh.hpp"
#include "precompute/mesh/surface.hpp"
#include "precompute/mesh/tet_mesh.hpp"
#include "precompute/mesh/tetgen_program.hpp"

namespace irdm::test {

using namespace irdm::precompute;

StaticCube::StaticCube(int cells, double poisson_ratio, int order) {
  const Material material{2000.0, poisson_ratio, 110.0, 8.0, 2e-4};
  TetMesh mesh = tetrahedralise(box_surface(Vector3::Constant(0.12), {cells, cells, cells}));
  if (order == 2) mesh = quadratic_mesh(mesh);
  Surface surface = extract_surface(mesh, "cube");
  mesh_.node_mass = lumped_mass(mesh, material);
  const MassProperties body = nodal_mass_properties(mesh.nodes, mesh_.node_mass);
  mesh.nodes.rowwise() -= body.centre_of_mass.transpose();
  mesh_.nodes = mesh.nodes;
  mesh_.tets = mesh.tets;
  mesh_.surface_nodes = surface.nodes;
  mesh_.triangles = surface.triangles;
  rigid_ = rigid_motions(mesh_.nodes, mesh_.node_mass);
  // Loads that are in balance need no support; a soft one at three nodes makes the matrix regular
  // and takes up nothing.
  SparseMatrix K = assemble_stiffness(mesh, material);
  for (const int node : {0, 1, static_cast<int>(mesh_.nodes.rows()) / 2}) {
    for (int axis = 0; axis < 3; ++axis) K.coeffRef(3 * node + axis, 3 * node + axis) += 1.0;
  }
  stiffness_.compute(K);
}

Matrix3 StaticCube::compliance(const ContactPatch& patch) const {
  const Eigen::Index unknowns = 3 * mesh_.nodes.rows();
  Eigen::MatrixXd load = Eigen::MatrixXd::Zero(unknowns, 3);
  for (std::size_t i = 0; i < static_cast<std::size_t>(patch.count); ++i) {
    const int node = mesh_.surface_nodes[static_cast<std::size_t>(patch.nodes[i])];
    load.middleRows<3>(3 * node) += patch.weights[i] * Matrix3::Identity();
  }
  // Less the forces of inertia M Phi Phi^T f.
  Eigen::MatrixXd inertia = rigid_ * (rigid_.transpose() * load);
  for (Eigen::Index i = 0; i < mesh_.nodes.rows(); ++i) {
    inertia.middleRows<3>(3 * i) *= mesh_.node_mass(i);
  }
  const Eigen::MatrixXd balanced = load - inertia;
  return balanced.transpose() * stiffness_.solve(balanced);
}

}  // namespace irdm::test
