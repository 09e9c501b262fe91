#include "precompute/dynamics/stepped_columns.hpp"

#include <numeric>

namespace irdm::precompute {

SteppedColumns::SteppedColumns(const TetMesh& mesh, const Material& material,
                               const TimeSteppingConfig& config, std::vector<int> surface_nodes,
                               double dt, int intervals, Precision precision)
    : body_(mesh, material, config.model),
      stepper_(body_),
      rotation_weights_(config.rotation_weights),
      surface_nodes_(std::move(surface_nodes)),
      dt_(dt),
      schedule_(step_schedule(config, dt, intervals)),
      force_(config.force > 0.0 ? config.force : default_force(body_, material.youngs_modulus)),
      precision_(precision) {
  for (const int count : schedule_) stepper_.prepare(dt / count);
}

int SteppedColumns::step_count() const {
  return std::accumulate(schedule_.begin(), schedule_.end(), 0);
}

Columns SteppedColumns::block(int k) const {
  RowMatrix<double> values = column(k);
  if (precision_ == Precision::kDouble) return values;
  return RowMatrix<float>(values.cast<float>());
}

RowMatrix<double> SteppedColumns::column(int b) const {
  RowMatrix<double> column(static_cast<Eigen::Index>(schedule_.size()),
                           static_cast<Eigen::Index>(3 * surface_nodes_.size()));
  BodyState state = body_.at_rest();
  ImplicitMidpoint::Workspace workspace;
  Eigen::VectorXd force = Eigen::VectorXd::Zero(state.u.size());
  force(3 * surface_nodes_[static_cast<std::size_t>(b / 3)] + b % 3) = force_;
  for (std::size_t s = 0; s < schedule_.size(); ++s) {
    const double h = dt_ / schedule_[s];
    for (int k = 0; k < schedule_[s]; ++k) stepper_.step(state, force, h, workspace);
    force.setZero();
    const Eigen::Map<const Points> u(state.u.data(), body_.rest().rows(), 3);
    const Points elastic =
        body_.elasticity() == Elasticity::kLinear
            ? linear_elastic_part(body_.rest(), u, body_.mass(), rotation_weights_)
            : elastic_part(body_.rest(), u,
                           extract_rigid_motion(body_.rest(), u, body_.mass(), rotation_weights_));
    for (std::size_t i = 0; i < surface_nodes_.size(); ++i) {
      column.block<1, 3>(static_cast<Eigen::Index>(s), static_cast<Eigen::Index>(3 * i)) =
          elastic.row(surface_nodes_[i]) / force_;
    }
  }
  return column;
}

}  // namespace irdm::precompute
