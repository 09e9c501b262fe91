#include "precompute/modal/elastic_modes.hpp"

#include <algorithm>
#include <string>

#include "precompute/fem/rigid_motions.hpp"
#include "precompute/modal/lowest_modes.hpp"

namespace irdm::precompute {
namespace {

// Eigenvalues up to this share of the largest are zero: the eigensolver leaves about 1e-16 of it,
// and a frequency at the limit is right to 0.1 %. One element of a millionth of the body's height
// makes the share 1e-12.
constexpr double kZeroShare = 1e-13;

Eigen::VectorXd per_degree_of_freedom(const Eigen::VectorXd& per_node) {
  return per_node.replicate(1, 3).transpose().reshaped();
}

int count_zero(const Eigen::VectorXd& values) {
  return static_cast<int>((values.array() <= kZeroShare * values.maxCoeff()).count());
}

// M^-1/2 K M^-1/2
Eigen::MatrixXd scaled_stiffness(const SparseMatrix& stiffness,
                                 const Eigen::VectorXd& inverse_root_mass) {
  const SparseMatrix scaled =
      inverse_root_mass.asDiagonal() * stiffness * inverse_root_mass.asDiagonal();
  return Eigen::MatrixXd(scaled);
}

// Degrees of freedom of the nodes that are not clamped.
std::vector<int> moving_degrees_of_freedom(Eigen::Index nodes, const std::vector<int>& clamped) {
  std::vector<int> moving;
  for (int node = 0; node < nodes; ++node) {
    if (std::binary_search(clamped.begin(), clamped.end(), node)) continue;
    for (int axis = 0; axis < 3; ++axis) moving.push_back(3 * node + axis);
  }
  return moving;
}

// Rows and columns of the given degrees of freedom, which increase.
SparseMatrix restricted(const SparseMatrix& matrix, const std::vector<int>& kept) {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    entries.emplace_back(kept[i], static_cast<int>(i), 1.0);
  }
  SparseMatrix selection(matrix.rows(), static_cast<Eigen::Index>(kept.size()));
  selection.setFromTriplets(entries.begin(), entries.end());
  return selection.transpose() * matrix * selection;
}

void check_rigid_modes(const EigenPairs& pairs, const Eigen::MatrixXd& rigid) {
  const int zero = count_zero(pairs.values);
  if (zero != 6) {
    throw LostModes("the free body has " + std::to_string(zero) +
                    " modes without elastic energy instead of six");
  }
  const Eigen::VectorXd overlap =
      (rigid.transpose() * pairs.vectors.leftCols(6)).colwise().squaredNorm().transpose();
  if (overlap.minCoeff() < 1.0 - 1e-6) {
    throw LostModes("the six lowest modes are not the rigid motions of the body");
  }
}

}  // namespace

ElasticModes elastic_modes(const SparseMatrix& stiffness, const Points& nodes,
                           const Eigen::VectorXd& mass) {
  const Eigen::VectorXd root_mass = per_degree_of_freedom(mass).cwiseSqrt();
  const Eigen::VectorXd inverse_root = root_mass.cwiseInverse();
  EigenPairs pairs = symmetric_eigen(scaled_stiffness(stiffness, inverse_root));

  // In the coordinates M^1/2 u the rigid motions are orthonormal columns.
  const Eigen::MatrixXd rigid = root_mass.asDiagonal() * rigid_motions(nodes, mass);
  check_rigid_modes(pairs, rigid);
  const Eigen::Index count = pairs.values.size() - 6;
  auto elastic = pairs.vectors.rightCols(count);
  const Eigen::MatrixXd rigid_part = rigid.transpose() * elastic;
  elastic.noalias() -= rigid * rigid_part;
  elastic = inverse_root.asDiagonal() * elastic;
  return {pairs.values.tail(count).cwiseSqrt(), elastic};
}

ElasticModes fixed_modes(const SparseMatrix& stiffness, const Eigen::VectorXd& mass,
                         const std::vector<int>& clamped) {
  const std::vector<int> moving = moving_degrees_of_freedom(mass.size(), clamped);
  const Eigen::VectorXd root_mass = per_degree_of_freedom(mass).cwiseSqrt();
  const Eigen::VectorXd inverse_root = root_mass(moving).cwiseInverse();
  const EigenPairs pairs =
      symmetric_eigen(scaled_stiffness(restricted(stiffness, moving), inverse_root));
  if (const int zero = count_zero(pairs.values); zero > 0) {
    throw LostModes("the fixed body has " + std::to_string(zero) + " modes without elastic energy");
  }
  ElasticModes modes{pairs.values.cwiseSqrt(),
                     Eigen::MatrixXd::Zero(stiffness.rows(), pairs.values.size())};
  modes.shapes(moving, Eigen::all) = inverse_root.asDiagonal() * pairs.vectors;
  return modes;
}

ModalResponse modal_response(const ElasticModes& modes, const std::vector<int>& surface_nodes,
                             const Material& material) {
  const Eigen::VectorXd& omega = modes.angular_frequency;
  RowMatrix<double> shapes(static_cast<Eigen::Index>(3 * surface_nodes.size()), omega.size());
  for (std::size_t i = 0; i < surface_nodes.size(); ++i) {
    shapes.middleRows<3>(static_cast<Eigen::Index>(3 * i)) =
        modes.shapes.middleRows<3>(3 * surface_nodes[i]);
  }
  const Eigen::VectorXd decay =
      0.5 * (material.rayleigh_alpha + material.rayleigh_beta * omega.array().square());
  return {omega, decay, std::move(shapes)};
}

}  // namespace irdm::precompute
