#pragma once

#include <Eigen/SparseCore>
#include <filesystem>
#include <memory>
#include <vector>

#include "common/geometry.hpp"
#include "common/model/model.hpp"

namespace irdm {

/// R_ii[s] of one node, (9, L): column s holds the nine entries column by column [m/N].
using DrivingPoint = Eigen::Matrix<double, 9, Eigen::Dynamic>;

/// c = a b^T.
using TransposedProduct = void (*)(const RowMatrix<double>& a, const RowMatrix<double>& b,
                                   RowMatrix<double>& c);
void transposed_product(const RowMatrix<double>& a, const RowMatrix<double>& b,
                        RowMatrix<double>& c);

/// The elastic impulse response R of one object as it is stored, equation (10), whatever the form:
/// modal, dense, streamed, compressed, or zero of a rigid body. For what is found once: checks,
/// errors, colours, the zero-lag compliance. A ResponseEngine evaluates the same forms step by
/// step. n surface nodes; degree of freedom 3 i + axis, B. Const members may be called from any
/// thread; not real-time safe.
class StoredResponse {
 public:
  virtual ~StoredResponse() = default;

  /// R[0 .. steps-1](:, b): (steps, 3n) [m/N]. Throws Error when a file cannot be read.
  virtual RowMatrix<double> column(int b, int steps) const = 0;
  /// The static limit of a column: displacement under a force of 1 N on b that stays, sum_s R[s](:,
  /// b), (3n) [m/N]. For all time; of a dense response as far as it was recorded.
  virtual Eigen::VectorXd static_column(int b) const = 0;
  /// Returns the static limits of all columns, (3n, 3n) [m/N].
  virtual Eigen::MatrixXd static_limit() const;
  /// How far each load yields to itself when it stays, l^T (sum_s R[s]) l [m/N].
  /// @param loads (3n, loads): column by column what each degree of freedom takes of 1 N
  virtual Eigen::VectorXd static_compliance(const Eigen::SparseMatrix<double>& loads) const;
  /// R_ii[0 .. steps-1] of the nodes first .. first+count-1.
  virtual std::vector<DrivingPoint> driving_points(int first, int count, int steps) const;
  /// R[0], the displacement within the step of all nodes per force on each: (3n, 3n) [m/N].
  virtual Eigen::MatrixXd zero_lag() const = 0;
};

/// Of a model that holds a response. Of a streamed one, R between step 0 and the static limit is
/// what stands in for a column that is not in memory (StreamedResponse::settling).
/// @param model must outlive the result  @param product a faster one, where there is a BLAS
std::unique_ptr<StoredResponse> stored_response(const Model& model,
                                                TransposedProduct product = transposed_product);

/// Of modes, sampled every dt [s].
/// @param response must outlive the result
std::unique_ptr<StoredResponse> stored_response(const ModalResponse& response, double dt,
                                                TransposedProduct product = transposed_product);

/// @param response must outlive the result
std::unique_ptr<StoredResponse> stored_response(const CompressedResponse& response,
                                                TransposedProduct product = transposed_product);

/// Of /response/dense/R in a file, one column in memory at a time. Throws Error when the dataset
/// has another shape, and later when it cannot be read, as where a chunk does not match its
/// checksum.
std::unique_ptr<StoredResponse> stored_response(const std::filesystem::path& path,
                                                int degrees_of_freedom, int steps);

/// StoredResponse::static_compliance() of a model, without rigid motion. NaN where the model holds
/// no response.
Eigen::VectorXd static_compliance(const Model& model, const Eigen::SparseMatrix<double>& loads);

}  // namespace irdm
