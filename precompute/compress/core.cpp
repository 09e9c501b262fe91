#include "precompute/compress/core.hpp"

#include <algorithm>

#include "precompute/compress/products.hpp"

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

}  // namespace irdm::precompute
