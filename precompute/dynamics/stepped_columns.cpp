#include "precompute/dynamics/stepped_columns.hpp"

#include <algorithm>
#include <numeric>

namespace irdm::precompute {
namespace {

constexpr int kLinearColumnsAtOnce = 16;

// Of the elements [Pa].
double softest_modulus(const Material& material) {
  const std::vector<double>& own = material.elements.youngs_modulus;
  return own.empty() ? material.youngs_modulus : *std::ranges::min_element(own);
}

}  // namespace

SteppedColumns::SteppedColumns(const TetMesh& mesh, const Material& material,
                               const TimeSteppingConfig& config, std::vector<int> surface_nodes,
                               double dt, int intervals, Precision precision)
    : body_(mesh, material, config.model),
      rotation_weights_(config.rotation_weights),
      surface_nodes_(std::move(surface_nodes)),
      dt_(dt),
      schedule_(step_schedule(config, dt, intervals)),
      force_(config.force > 0.0 ? config.force : default_force(body_, softest_modulus(material))),
      precision_(precision),
      block_size_(1) {
  if (config.model == Elasticity::kLinear) {
    block_size_ = limited_block_size(kLinearColumnsAtOnce, intervals, columns(), sizeof(double));
    linear_.emplace(body_);
    for (const int count : schedule_) linear_->prepare(dt / count);
  } else {
    corotational_.emplace(body_);
    for (const int count : schedule_) corotational_->prepare(dt / count);
  }
}

int SteppedColumns::step_count() const {
  return std::accumulate(schedule_.begin(), schedule_.end(), 0);
}

Eigen::MatrixXd SteppedColumns::forces(const ColumnRange& range) const {
  Eigen::MatrixXd force = Eigen::MatrixXd::Zero(body_.rest().size(), range.count());
  for (int b = range.begin; b < range.end; ++b) {
    force(3 * surface_nodes_[static_cast<std::size_t>(b / 3)] + b % 3, b - range.begin) = force_;
  }
  return force;
}

void SteppedColumns::record(const Points& elastic, Eigen::Index row,
                            RowMatrix<double>& columns) const {
  for (std::size_t i = 0; i < surface_nodes_.size(); ++i) {
    columns.block<1, 3>(row, static_cast<Eigen::Index>(3 * i)) =
        elastic.row(surface_nodes_[i]) / force_;
  }
}

RowMatrix<double> SteppedColumns::linear_block(const ColumnRange& range) const {
  const auto intervals = static_cast<Eigen::Index>(schedule_.size());
  RowMatrix<double> result(range.count() * intervals, columns());
  Eigen::MatrixXd u = Eigen::MatrixXd::Zero(body_.rest().size(), range.count());
  Eigen::MatrixXd v = u;
  Eigen::MatrixXd force = forces(range);
  for (Eigen::Index s = 0; s < intervals; ++s) {
    const int count = schedule_[static_cast<std::size_t>(s)];
    for (int k = 0; k < count; ++k) linear_->step(u, v, force, dt_ / count);
    force.setZero();
    for (Eigen::Index b = 0; b < range.count(); ++b) {
      record(
          linear_elastic_part(body_.rest(), as_points(u.col(b)), body_.mass(), rotation_weights_),
          b * intervals + s, result);
    }
  }
  return result;
}

RowMatrix<double> SteppedColumns::corotational_column(int b) const {
  const auto intervals = static_cast<Eigen::Index>(schedule_.size());
  RowMatrix<double> result(intervals, columns());
  BodyState state = body_.at_rest();
  ImplicitMidpoint::Workspace workspace;
  Eigen::VectorXd force = forces({b, b + 1});
  for (Eigen::Index s = 0; s < intervals; ++s) {
    const int count = schedule_[static_cast<std::size_t>(s)];
    for (int k = 0; k < count; ++k) corotational_->step(state, force, dt_ / count, workspace);
    force.setZero();
    const auto u = as_points(state.u);
    record(elastic_part(body_.rest(), u,
                        extract_rigid_motion(body_.rest(), u, body_.mass(), rotation_weights_)),
           s, result);
  }
  return result;
}

RowMatrix<double> SteppedColumns::values(int k) const {
  return linear_ ? linear_block(block_range(k)) : corotational_column(k);
}

Columns SteppedColumns::block(int k) const {
  RowMatrix<double> wide = values(k);
  if (precision_ == Precision::kDouble) return wide;
  return RowMatrix<float>(wide.cast<float>());
}

RowMatrix<double> SteppedColumns::column(int b) const {
  const int k = b / block_size_;
  const auto intervals = static_cast<Eigen::Index>(schedule_.size());
  return values(k).middleRows((b - k * block_size_) * intervals, intervals);
}

}  // namespace irdm::precompute
