#pragma once

#include <Eigen/SparseCholesky>
#include <memory>

#include "common/model/model.hpp"
#include "simulation/contact/contact_patch.hpp"

namespace irdm::test {

/// The paper's cube (12 cm, E = 2000 Pa, 110 kg/m^3) as a floating body at rest: what a static
/// solve on its whole mesh says, without modes, responses or steps.
class StaticCube {
 public:
  StaticCube(int cells, double poisson_ratio, int order);

  /// Nodes, tetrahedra, surface and nodal masses, in B.
  const ModelMesh& mesh() const noexcept { return mesh_; }

  /// Mean elastic displacement of a patch per force on it, spread alike and balanced by the inertia
  /// of the body [m/N].
  Matrix3 compliance(const ContactPatch& patch) const;

 private:
  ModelMesh mesh_;
  Eigen::Matrix<double, Eigen::Dynamic, 6> rigid_;  ///< motions, of unit mass (3N, 6)
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> stiffness_;
};

}  // namespace irdm::test
