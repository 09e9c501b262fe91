#include "common/response/compressed_response.hpp"

#include <algorithm>
#include <complex>

namespace irdm {

RowMatrix<double> tail_responses(const CompressedResponse& response, int steps) {
  RowMatrix<double> h = RowMatrix<double>::Zero(steps, response.shape_count());
  for (int j = 0; j < response.pole_count(); ++j) {
    const int shape = response.pole_shape[static_cast<std::size_t>(j)];
    std::complex<double> term = response.amplitude(j);
    for (int s = 0; s < steps; ++s, term *= response.pole(j)) h(s, shape) += term.real();
  }
  return h;
}

Eigen::VectorXd settled_tail_responses(const CompressedResponse& response) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(response.shape_count());
  for (int j = 0; j < response.pole_count(); ++j) {
    sum(response.pole_shape[static_cast<std::size_t>(j)]) +=
        (response.amplitude(j) / (1.0 - response.pole(j))).real();
  }
  return sum;
}

RowMatrix<double> compressed_column(const CompressedResponse& response,
                                    const RowMatrix<double>& tail, int b, int steps) {
  const auto dof = static_cast<int>(response.shapes.rows());
  RowMatrix<double> column(steps, dof);
  const int fir = std::min(response.fir_steps, steps);
  for (int a = 0; a < dof; ++a) {
    with_fir(response, a / 3, a % 3, b / 3, b % 3, [&](const auto* numbers, double scale) {
      for (int s = 0; s < fir; ++s) column(s, a) = scale * static_cast<double>(numbers[s]);
    });
  }
  if (steps > fir) {
    const RowMatrix<double> weighted =
        tail.topRows(steps - fir).array().rowwise() * response.shapes.row(b).cast<double>().array();
    column.bottomRows(steps - fir).noalias() =
        weighted * response.shapes.cast<double>().transpose();
  }
  return column;
}

}  // namespace irdm
