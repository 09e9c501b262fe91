#pragma once

#include <Eigen/Dense>
#include <array>

#include "common/geometry.hpp"
#include "common/model/model.hpp"

/// Two floating bodies pressed together at rest, by finite elements on the whole mesh of each:
/// K u = f with nodal contact forces, without modes, R, patches or the solver of a step.
namespace irdm::test {

/// One of the two, where it touches the other without force.
struct FemContactBody {
  ModelMesh mesh;  ///< B: the centre of mass is the origin
  Material material;
  Vector3 position = Vector3::Zero();               ///< of the centre of mass [m], W
  Quaternion orientation = Quaternion::Identity();  ///< B to W
};

/// A cube of 12 cm with more elements than a step could do with. @param order of the tetrahedra
FemContactBody fine_cube(int cells, int order, const Material& material);

/// How they are pressed together: along y, by uniform body forces on both.
struct FemPress {
  double force = 0.0;   ///< that the upper body is pressed down with [N], > 0
  bool sticks = false;  ///< what is closed does not move sideways; else there is no friction
  /// Which motions of the upper body come of the equilibrium: along and about x, y, z. The others
  /// are held.
  std::array<bool, 6> moves{false, true, false, false, false, false};
};

/// The solution: nodes of the upper body that face the lower one, and what acts on them.
struct FemContact {
  Points position;        ///< at rest [m], W
  Points force;           ///< of the lower on the upper body [N], W; 0: open
  Eigen::VectorXd gap;    ///< between the nodes and the face below them [m]
  Eigen::VectorXd area;   ///< of the upper surface about them that faces down, horizontal [m^2]
  double approach = 0.0;  ///< of the centres of mass, along y [m]
};

/// Node to surface: a node of the upper body's surface that is above the lower body's face of
/// greatest y, and less than `reach` [m] above it, must not come below it. Exact but for rounding:
/// a primal-dual active set of the nodes that carry. Arms are those at rest.
/// Throws std::runtime_error when the set does not settle.
FemContact fem_contact(const FemContactBody& lower, const FemContactBody& upper,
                       const FemPress& press, double reach);

}  // namespace irdm::test
