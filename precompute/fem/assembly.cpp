#include "precompute/fem/assembly.hpp"

#include <algorithm>
#include <vector>

#include "precompute/fem/tetrahedra.hpp"

namespace irdm::precompute {
namespace {

Eigen::MatrixXd element_stiffness(const TetMesh& mesh, int e, const Material& material) {
  const Lame lame = lame_parameters(material, e);
  if (mesh.order() == 2) return tet10::stiffness(mesh, e, lame);
  return tet4::stiffness(tet4::geometry(corners_of(mesh, e)), lame);
}

// Share of an element's mass that each of its nodes gets.
Eigen::VectorXd mass_shares(int order) {
  if (order == 1) return Eigen::VectorXd::Constant(4, 0.25);
  return tet10::mass_shares();
}

}  // namespace

SparseMatrix assemble_stiffness(const TetMesh& mesh, const Material& material) {
  std::vector<Eigen::Triplet<double>> entries;
  const Eigen::Index size = 3 * mesh.tets.cols();
  entries.reserve(static_cast<std::size_t>(mesh.tet_count() * size * size));
  for (int e = 0; e < mesh.tet_count(); ++e) {
    const Eigen::MatrixXd k = element_stiffness(mesh, e, material);
    for (int row = 0; row < size; ++row) {
      for (int column = 0; column < size; ++column) {
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

RowSparseMatrix assemble_stiffness_rows(const TetMesh& mesh, const Material& material, int first,
                                        int last) {
  std::vector<Eigen::Triplet<double>> entries;
  const auto wanted = [&](int node) { return node >= first && node < last; };
  for (int e = 0; e < mesh.tet_count(); ++e) {
    const auto nodes = mesh.tets.row(e);
    if (std::none_of(nodes.begin(), nodes.end(), wanted)) continue;
    const Eigen::MatrixXd k = element_stiffness(mesh, e, material);
    for (int row = 0; row < k.rows(); ++row) {
      if (!wanted(nodes(row / 3))) continue;
      for (int column = 0; column < k.cols(); ++column) {
        entries.emplace_back(3 * (nodes(row / 3) - first) + row % 3,
                             3 * nodes(column / 3) + column % 3, k(row, column));
      }
    }
  }
  RowSparseMatrix rows(3 * (last - first), 3 * mesh.nodes.rows());
  rows.setFromTriplets(entries.begin(), entries.end());
  return rows;
}

Eigen::VectorXd lumped_mass(const TetMesh& mesh, const Material& material) {
  Eigen::VectorXd mass = Eigen::VectorXd::Zero(mesh.node_count());
  const Eigen::VectorXd shares = mass_shares(mesh.order());
  for (int e = 0; e < mesh.tet_count(); ++e) {
    const double element_mass = density_of(material, e) * element_volume(mesh, e);
    for (int i = 0; i < shares.size(); ++i) mass(mesh.tets(e, i)) += shares(i) * element_mass;
  }
  return mass;
}

Eigen::Matrix<double, Eigen::Dynamic, kSpinProducts> centrifugal_loads(
    const Points& nodes, const Eigen::VectorXd& mass) {
  Eigen::Matrix<double, Eigen::Dynamic, kSpinProducts> loads(3 * nodes.rows(), kSpinProducts);
  for (Eigen::Index i = 0; i < nodes.rows(); ++i) {
    const double x = nodes(i, 0);
    const double y = nodes(i, 1);
    const double z = nodes(i, 2);
    Eigen::Matrix<double, 3, kSpinProducts> load;
    // One column each: xx, yy, zz push away from the axis, the mixed ones take -w (w . X) apart.
    load << 0, x, x, 0, -z, -y,  //
        y, 0, y, -z, 0, -x,      //
        z, z, 0, -y, -x, 0;
    loads.middleRows<3>(3 * i) = mass(i) * load;
  }
  return loads;
}

Eigen::Matrix<double, Eigen::Dynamic, 3> uniform_loads(const Eigen::VectorXd& mass) {
  Eigen::Matrix<double, Eigen::Dynamic, 3> loads(3 * mass.size(), 3);
  for (Eigen::Index i = 0; i < mass.size(); ++i) {
    loads.middleRows<3>(3 * i) = mass(i) * Eigen::Matrix3d::Identity();
  }
  return loads;
}

}  // namespace irdm::precompute
