#include "precompute/modal/body_loads.hpp"

#include "precompute/fem/centrifugal_load.hpp"
#include "precompute/fem/uniform_load.hpp"

namespace irdm::precompute {

void add_body_loads(const ElasticModes& modes, const Model& model, ModalResponse& response) {
  if (model.body.support == Support::kFloating) {
    response.centrifugal =
        modes.shapes.transpose() * centrifugal_loads(model.mesh.nodes, model.mesh.node_mass);
  } else {
    response.gravity = modes.shapes.transpose() * uniform_loads(model.mesh.node_mass);
  }
}

void add_gravity_rest(const ElasticStatics& statics, const Model& model, ModalResponse& response) {
  if (response.gravity.rows() == 0) return;
  const Eigen::MatrixXd all = statics.displacement(uniform_loads(model.mesh.node_mass));
  const auto& shapes = std::get<RowMatrix<double>>(response.shapes);
  response.gravity_rest = -shapes *
                          response.angular_frequency.cwiseAbs2().cwiseInverse().asDiagonal() *
                          response.gravity;
  for (int i = 0; i < model.mesh.surface_node_count(); ++i) {
    const int node = model.mesh.surface_nodes[static_cast<std::size_t>(i)];
    response.gravity_rest.middleRows<3>(3 * i) += all.middleRows<3>(3 * node);
  }
}

}  // namespace irdm::precompute
