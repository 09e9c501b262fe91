#pragma once

#include "common/model/model.hpp"

namespace irdm::test {

/// The smallest model: one tetrahedron with edges of 1 m along the axes, without a response.
inline Model one_tet_model(int steps) {
  Model model;
  model.mesh.nodes.resize(4, 3);
  model.mesh.nodes << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1;
  model.mesh.tets.resize(1, 4);
  model.mesh.tets << 0, 1, 2, 3;
  model.mesh.surface_nodes = {0, 1, 2, 3};
  model.mesh.triangles.resize(4, 3);
  model.mesh.triangles << 0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2;
  model.mesh.node_mass = Eigen::VectorXd::Constant(4, 0.25);
  model.body.mass = 1.0;
  model.body.inertia = Vector3(1, 2, 3).asDiagonal();
  model.material = {2000, 0.49, 110, 8, 2e-4};
  model.dt = 0.002;
  model.steps = steps;
  return model;
}

}  // namespace irdm::test
