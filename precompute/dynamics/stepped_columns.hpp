#pragma once

#include <optional>
#include <vector>

#include "common/model/model_writer.hpp"
#include "precompute/columns/column_source.hpp"
#include "precompute/config.hpp"
#include "precompute/dynamics/implicit_midpoint.hpp"

namespace irdm::precompute {

/// Columns of R as the paper has them: a force on one surface degree of freedom of the
/// free-floating body, held during the first interval, then none; the elastic part recorded after
/// every interval.
class SteppedColumns final : public ColumnSource {
 public:
  /// Factorises for all steps of the schedule.
  /// @param mesh linear tetrahedra
  /// @param surface_nodes (n), into the nodes of the mesh
  /// @param precision of block()
  SteppedColumns(const TetMesh& mesh, const Material& material, const TimeSteppingConfig& config,
                 std::vector<int> surface_nodes, double dt, int intervals,
                 Precision precision = Precision::kDouble);

  int columns() const override { return 3 * static_cast<int>(surface_nodes_.size()); }
  /// Columns of the linear body are stepped together.
  int block_size() const override { return block_size_; }
  Columns block(int k) const override;

  /// R[s](a, b) for all s and a: shape (T, 3n) [m/N]. For any number of threads at a time; the
  /// result does not depend on them.
  RowMatrix<double> column(int b) const;

  double force() const { return force_; }  ///< that columns are simulated with [N]
  int step_count() const;                  ///< of one column

 private:
  Eigen::MatrixXd forces(const ColumnRange& range) const;
  RowMatrix<double> linear_block(const ColumnRange& range) const;
  RowMatrix<double> corotational_column(int b) const;
  RowMatrix<double> values(int k) const;
  void record(const Points& elastic, Eigen::Index row, RowMatrix<double>& columns) const;

  SoftBody body_;
  std::optional<LinearMidpoint> linear_;
  std::optional<ImplicitMidpoint> corotational_;
  RotationWeights rotation_weights_;
  std::vector<int> surface_nodes_;
  double dt_;
  std::vector<int> schedule_;
  double force_;
  Precision precision_;
  int block_size_;
};

}  // namespace irdm::precompute
