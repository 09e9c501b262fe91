#pragma once

#include <Eigen/Dense>
#include <vector>

#include "common/model/model.hpp"

namespace irdm::precompute {

/// A round fingertip that presses straight down on the surface somewhere.
struct Fingertip {
  std::vector<int> nodes;       ///< surface nodes that it presses on
  std::vector<double> weights;  ///< shares of its force, sum 1
  Vector3 direction;            ///< into the body, unit length
};

/// Fingertips far from each other all over the surface, so that faces, edges and corners are among
/// them; none on clamped nodes as long as there are other places. The pressure falls as 1 - s^2
/// with the distance s from the middle, in units of the radius; where the mesh is too coarse for
/// that it is one node.
/// @param clamped into the mesh's nodes, increasing
std::vector<Fingertip> spread_fingertips(const ModelMesh& mesh, double radius, int count,
                                         const std::vector<int>& clamped);

/// Forces of 1 N under each fingertip on all nodes, (3N, k) [N].
Eigen::MatrixXd loads_of(const std::vector<Fingertip>& tips, const ModelMesh& mesh);

/// The fingertip's mean of a quantity of the surface's degrees of freedom, along its direction: of
/// each column of values (3n, k), (k).
Eigen::VectorXd mean_under(const Fingertip& tip, const Eigen::Ref<const Eigen::MatrixXd>& values);

}  // namespace irdm::precompute
