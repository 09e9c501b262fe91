#include "precompute/fem/assembly.hpp"

#include <vector>

#include "precompute/fem/tet4.hpp"

namespace irdm::precompute {

SparseMatrix assemble_stiffness(const TetMesh& mesh, const Lame& lame) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(static_cast<std::size_t>(mesh.tet_count()) * 144);
  for (int e = 0; e < mesh.tet_count(); ++e) {
    tet4::Corners corners;
    for (int i = 0; i < 4; ++i) corners.row(i) = mesh.nodes.row(mesh.tets(e, i));
    const tet4::Stiffness k = tet4::stiffness(tet4::geometry(corners), lame);
    for (int row = 0; row < 12; ++row) {
      for (int column = 0; column < 12; ++column) {
        entries.emplace_back(3 * mesh.tets(e, row / 3) + row % 3,
                             3 * mesh.tets(e, column / 3) + column % 3, k(row, column));
      }
    }
  }
  const Eigen::Index unknowns = 3 * mesh.nodes.rows();
  SparseMatrix stiffness(unknowns, unknowns);
  stiffness.setFromTriplets(entries.begin(), entries.end());
  return stiffness;
}

Eigen::VectorXd lumped_mass(const TetMesh& mesh, double density) {
  Eigen::VectorXd mass = Eigen::VectorXd::Zero(mesh.node_count());
  for (int e = 0; e < mesh.tet_count(); ++e) {
    const double quarter = 0.25 * density * signed_volume(mesh, e);
    for (int i = 0; i < 4; ++i) mass(mesh.tets(e, i)) += quarter;
  }
  return mass;
}

}  // namespace irdm::precompute
