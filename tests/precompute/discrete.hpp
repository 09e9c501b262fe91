#pragma once

#include <Eigen/Dense>

#include "precompute/fem/assembly.hpp"
#include "precompute/mesh/tet_mesh.hpp"

namespace irdm::test {

using namespace precompute;

/// A meshed body with its matrices.
struct Discrete {
  TetMesh mesh;
  SparseMatrix stiffness;
  Eigen::VectorXd mass;   ///< (N)
  Eigen::VectorXd mass3;  ///< (3N)
  Eigen::MatrixXd rigid;  ///< (3N, 6), mass-normalised

  Discrete(TetMesh m, const Material& material);

  Eigen::MatrixXd without_rigid(const Eigen::MatrixXd& u) const;
};

/// The node nearest to x.
int node_at(const TetMesh& mesh, const Vector3& x);

/// Static answer of the free body to a force: what accelerates the body as a whole is taken off the
/// force, the rest is solved with six degrees of freedom of the nodes a, b and c held (no reaction
/// comes there), and the rigid motion that this choice brings is removed. b lies along x from a, c
/// along y.
Eigen::VectorXd inertia_relief(const Discrete& body, const Eigen::VectorXd& force, int a, int b,
                               int c);

/// Lowest elastic eigenvalues of the free body by subspace iteration on (K + shift M)^-1 M: nothing
/// in common with the dense solver.
Eigen::VectorXd lowest_eigenvalues(const Discrete& body, double shift, int block, int rounds);

/// Lowest elastic frequency of the free body [Hz].
double lowest_frequency(const Discrete& body, double shift);

}  // namespace irdm::test
