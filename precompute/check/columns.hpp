#pragma once

#include <filesystem>
#include <memory>

#include "common/hdf5/file.hpp"
#include "common/model/model.hpp"
#include "precompute/check/transfer.hpp"

namespace irdm::precompute {

/// Where the checks read R: never all of it at once.
class ResponseColumns {
 public:
  virtual ~ResponseColumns() = default;
  /// R[s](a, b) of the first `steps` steps: (steps, 3n) [m/N].
  virtual RowMatrix<double> column(int b, int steps) const = 0;
  /// Displacement under a force of 1 N on b that stays: sum_s R[s](:, b), (3n) [m/N].
  virtual Eigen::VectorXd settled(int b) const = 0;
};

/// Out of the modes and what they leave out: settled() is the limit for all time.
class ModalColumns : public ResponseColumns {
 public:
  /// @param response with shapes in double precision; must outlive this
  ModalColumns(const ModalResponse& response, double dt) : response_(response), dt_(dt) {}
  RowMatrix<double> column(int b, int steps) const override;
  Eigen::VectorXd settled(int b) const override;
  /// Surface nodes where b's column has what modes that are left out do; every one where none are.
  std::vector<int> complete_nodes(int b) const;

 private:
  Eigen::VectorXd residual(int b) const;
  const RowMatrix<double>& shapes() const { return std::get<RowMatrix<double>>(response_.shapes); }
  const ModalResponse& response_;
  double dt_;
};

/// Out of /response/dense/R, one column a time: settled() sums the T steps that there are. Throws
/// Error when the dataset cannot be read, as where a chunk does not match its checksum.
class StoredColumns : public ResponseColumns {
 public:
  StoredColumns(const std::filesystem::path& path, int degrees_of_freedom, int steps);
  RowMatrix<double> column(int b, int steps) const override;
  Eigen::VectorXd settled(int b) const override;
  /// Whether every chunk carries a Fletcher32 checksum.
  bool has_checksums() const;

 private:
  hdf5::File file_;
  int degrees_of_freedom_;
  int steps_;
};

/// Out of a compressed response: settled() is the limit for all time.
class CompressedColumns : public ResponseColumns {
 public:
  /// @param response must outlive this
  explicit CompressedColumns(const CompressedResponse& response) : response_(response) {}
  RowMatrix<double> column(int b, int steps) const override;
  Eigen::VectorXd settled(int b) const override;
  /// R_ii[s] of one node.
  /// @param tail steps - m rows of tail_responses()
  DrivingPoint driving_point(int node, const RowMatrix<double>& tail) const;

 private:
  const CompressedResponse& response_;
};

/// R_ii[s] of the nodes first .. first+count-1.
/// @param response of the modes, with shapes in double precision
/// @param held responses of the modes, (L, r)
std::vector<DrivingPoint> modal_driving_points(const ModalResponse& response,
                                               const RowMatrix<double>& held, int first, int count);

/// A record that is long enough to stand for one without end.
struct RecordLength {
  int steps;
  /// Of the circle that counts as the unit circle: what lies beyond the record weighs less than
  /// 1e-9 on it. 1 unless the modes hardly decay.
  double radius;
};
RecordLength record_length(const ModalResponse& response, double dt);
RecordLength record_length(const CompressedResponse& response);

}  // namespace irdm::precompute
