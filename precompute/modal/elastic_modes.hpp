#pragma once

#include <Eigen/Dense>
#include <string>

#include "common/error.hpp"
#include "common/geometry.hpp"
#include "common/model/model.hpp"
#include "precompute/fem/assembly.hpp"

namespace irdm::precompute {

/// Elastic modes of the mesh: K phi = omega^2 M phi. r of them: 3N - 6 of a free body, three less a
/// clamped node of a fixed one.
struct ElasticModes {
  Eigen::VectorXd angular_frequency;  ///< omega (r), increasing, > 0 [rad/s]
  Eigen::MatrixXd shapes;             ///< (3N, r), Phi^T M Phi = Id [kg^-1/2]
};

/// Thrown where the lowest elastic modes are lost in the rounding of the highest: parts of the body
/// hang loose, or an element is so flat that its stiffness hides that of the body.
class LostModes : public Error {
 public:
  /// @param what what was found
  explicit LostModes(const std::string& what)
      : Error("mesh", what,
              "check for elements that hang on a single node or edge, and for very thin parts") {}
};

/// All elastic modes of a floating body, from the eigenvectors of M^-1/2 K M^-1/2. The six rigid
/// modes are recognised by their vanishing eigenvalue and their overlap with the analytic rigid
/// motions, and left out; what rounding left of rigid motion in the others is removed, so that they
/// carry no momentum. Throws LostModes when there are not exactly six.
/// @param stiffness (3N, 3N) [N/m]
/// @param nodes (N, 3) [m]
/// @param mass lumped (N) [kg]
ElasticModes elastic_modes(const SparseMatrix& stiffness, const Points& nodes,
                           const Eigen::VectorXd& mass);

/// All modes of a body with clamped nodes, whose rows of the shapes are zero. Throws LostModes when
/// one of them has no elastic energy.
/// @param clamped into the nodes, increasing; three of them not on a line
ElasticModes fixed_modes(const SparseMatrix& stiffness, const Eigen::VectorXd& mass,
                         const std::vector<int>& clamped);

/// R in modal form: shapes at the surface, decay rates sigma = (alpha + beta omega^2) / 2.
/// @param surface_nodes (n) into the mesh's nodes
ModalResponse modal_response(const ElasticModes& modes, const std::vector<int>& surface_nodes,
                             const Material& material);

}  // namespace irdm::precompute
