#pragma once

#include <array>
#include <vector>

#include "precompute/fem/assembly.hpp"
#include "precompute/parallel/ranks.hpp"
#include "precompute/parallel/slepc_session.hpp"

namespace irdm::precompute {

/// M^-1/2 K M^-1/2 + shift, whose rows the ranks share: each has a compact part of the nodes and
/// assembles its rows. Of clamped rows and columns only the diagonal is left. Made by all ranks
/// together; each has the mesh. N nodes.
class SharedStiffness {
 public:
  /// Throws Error.
  /// @param mass lumped (N) [kg]
  /// @param clamped into the nodes, increasing; none: the body is free
  SharedStiffness(const TetMesh& mesh, const Material& material, const Eigen::VectorXd& mass,
                  const std::vector<int>& clamped, const Ranks& ranks);

  Mat matrix() const { return matrix_; }
  /// The six rigid motions in the coordinates M^1/2 u, orthonormal.
  std::array<Vec, 6> rigid() const;
  bool free() const { return clamped_.empty(); }
  /// What makes the matrix of a free body definite [1/s^2]; 0 of a fixed one.
  double shift() const { return shift_; }
  /// A scale of omega^2: the largest stiffness over mass of a degree of freedom [1/s^2].
  double largest_square() const { return largest_square_; }
  Eigen::Index degrees_of_freedom() const { return root_mass_.size(); }  ///< 3N
  /// On rank 0: u of a vector M^1/2 u, nodes as in the mesh, (3N); empty on the others. By all.
  Eigen::VectorXd displacement(Vec vector) const;

 private:
  RowSparseMatrix own_rows(const TetMesh& ordered, const Material& material,
                           const Eigen::VectorXd& root);
  void make_matrix(const RowSparseMatrix& rows);
  void make_rigid(const TetMesh& ordered, const Eigen::VectorXd& mass);

  const Ranks& ranks_;
  std::vector<int> order_;     // nodes of the mesh, as they are shared out
  std::vector<int> clamped_;   // nodes of the mesh
  Eigen::VectorXd root_mass_;  // (3N), nodes as in the mesh
  double shift_;
  double largest_square_ = 0.0;
  SlepcObject<Mat, MatDestroy> matrix_;
  std::array<SlepcObject<Vec, VecDestroy>, 6> rigid_;
};

}  // namespace irdm::precompute
