#include "common/response/compressed_response.hpp"

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

}  // namespace irdm
