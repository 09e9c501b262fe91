#include "precompute/compress/tail_space.hpp"

#include <algorithm>
#include <cmath>

#include "common/error.hpp"
#include "common/response/compressed_response.hpp"
#include "precompute/blas.hpp"
#include "precompute/compress/joint_shapes.hpp"
#include "precompute/modal/lowest_modes.hpp"

namespace irdm::precompute {
namespace {

constexpr int kColumnsAtOnce = 64;

// M_k += sum_b (G_k^T R_b U)^T U_b
void add_columns(const std::vector<RowMatrix<float>>& projected, const RowMatrix<float>& rows,
                 Core& core) {
  const Eigen::Index r = core.rank();
  RowMatrix<float> left(static_cast<Eigen::Index>(projected.size()), r);
  RowMatrix<float> part;
  for (Eigen::Index k = 0; k < core.times(); ++k) {
    for (Eigen::Index i = 0; i < left.rows(); ++i) {
      left.row(i) = projected[static_cast<std::size_t>(i)].row(k);
    }
    product(left, Of::kTransposed, rows, Of::kItself, part);
    core.matrices.middleRows(k * r, r) += part;
  }
}

void make_symmetric(Core& core) {
  const Eigen::Index r = core.rank();
  for (Eigen::Index k = 0; k < core.times(); ++k) {
    auto M = core.matrices.middleRows(k * r, r);
    const RowMatrix<float> mean = 0.5F * (M + M.transpose());
    M = mean;
  }
}

}  // namespace

Core project(const DenseInput& input, const Survey& survey, int r, int K, const Console& console) {
  Core core;
  core.space = survey.space_vectors.leftCols(r).cast<float>();
  core.time = survey.time_vectors.leftCols(K);
  core.weight = survey.space_values.head(r);
  core.matrices = RowMatrix<float>::Zero(static_cast<Eigen::Index>(K) * r, r);
  const RowMatrix<float> time = core.time.cast<float>();
  const int dof = input.degrees_of_freedom();
  Progress progress(console, "projecting", dof);
  RowMatrix<float> in_time;
  for (int first = 0; first < dof; first += kColumnsAtOnce) {
    const int count = std::min(kColumnsAtOnce, dof - first);
    std::vector<RowMatrix<float>> projected(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
      const RowMatrix<float> later =
          input.column(first + i).bottomRows(input.steps() - survey.fir_steps);
      product(time, Of::kTransposed, later, Of::kItself, in_time);
      product(in_time, Of::kItself, core.space, Of::kItself,
              projected[static_cast<std::size_t>(i)]);
      progress.update(first + i + 1);
    }
    add_columns(projected, core.space.middleRows(first, count), core);
  }
  make_symmetric(core);
  return core;
}

namespace {

constexpr int kLateSamples = 250;

// Not a multiple of 3: all axes are sampled.
int sample_stride(int dof) {
  const int stride = std::max(1, dof / kLateSamples);
  return stride % 3 == 0 ? stride + 1 : stride;
}

// Half of R and half of its transpose: reciprocity.
void add_fir(const RowMatrix<float>& column, int b, Survey& survey) {
  const int m = survey.fir_steps;
  const int j = b / 3;
  const auto add = [&](int row, int first, int other, int second, int a) {
    float* entry = survey.fir.data() +
                   ((static_cast<std::size_t>(row) * (static_cast<std::size_t>(row) + 1) / 2 +
                     static_cast<std::size_t>(other)) *
                        9 +
                    static_cast<std::size_t>(3 * first + second)) *
                       static_cast<std::size_t>(m);
    for (int s = 0; s < m; ++s) entry[s] += 0.5F * column(s, a);
  };
  for (int a = 0; a < column.cols(); ++a) {
    const int i = a / 3;
    if (i >= j) add(i, a % 3, j, b % 3, a);
    if (i <= j) add(j, b % 3, i, a % 3, a);
  }
}

// Eigenpairs of a covariance as shares of the norm, most important ones first.
void directions(RowMatrix<double>& covariance, double norm, Eigen::VectorXd& values,
                Eigen::MatrixXd& vectors) {
  EigenPairs pairs = symmetric_eigen(covariance.transpose());
  covariance.resize(0, 0);
  values = pairs.values.reverse().cwiseMax(0.0).cwiseSqrt() / norm;
  vectors = pairs.vectors.rowwise().reverse();
}

}  // namespace

Survey survey(const DenseInput& input, int fir_steps, const Console& console) {
  const int dof = input.degrees_of_freedom();
  const int tail = input.steps() - fir_steps;
  Survey result;
  result.fir_steps = fir_steps;
  result.fir.assign(
      fir_entries(static_cast<std::size_t>(dof / 3)) * static_cast<std::size_t>(fir_steps), 0.0F);
  RowMatrix<double> space = RowMatrix<double>::Zero(dof, dof);
  RowMatrix<double> time = RowMatrix<double>::Zero(tail, tail);
  double energy = 0.0;
  int sampled = 0;
  const int stride = sample_stride(dof);
  Progress progress(console, "reading R", dof);
  for (int b = 0; b < dof; ++b) {
    const RowMatrix<float> column = input.column(b);
    add_fir(column, b, result);
    if (b % stride == 0) {
      const RowMatrix<double> later = column.bottomRows(tail).cast<double>();
      product(later, Of::kTransposed, later, Of::kItself, space, true);
      product(later, Of::kItself, later, Of::kTransposed, time, true);
      energy += column.cast<double>().squaredNorm();
      ++sampled;
    }
    progress.update(b + 1);
  }
  if (!(energy > 0.0))
    throw Error(input.name(), "has a dense response that is zero", "make it again");
  directions(space, std::sqrt(energy), result.space_values, result.space_vectors);
  directions(time, std::sqrt(energy), result.time_values, result.time_vectors);
  result.norm = std::sqrt(energy * dof / sampled);
  return result;
}

int directions_for(const Eigen::VectorXd& values, double share) {
  double left = 0.0;
  Eigen::Index count = values.size();
  while (count > 1) {
    left += values(count - 1) * values(count - 1);
    if (left > share * share) break;
    --count;
  }
  return static_cast<int>(count);
}

}  // namespace irdm::precompute
