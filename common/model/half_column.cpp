#include "common/model/half_column.hpp"

#include <cmath>

namespace irdm {

HalfColumn half_column(const RowMatrix<double>& column) {
  HalfColumn half;
  half.numbers.resize(static_cast<std::size_t>(column.size()));
  const double largest = column.cwiseAbs().maxCoeff();
  if (largest == 0.0) return half;
  half.scale = std::ldexp(1.0, std::ilogb(largest) - 14);
  RowMatrix<double> error(column.rows(), column.cols());
  for (Eigen::Index i = 0; i < column.size(); ++i) {
    const Half number = to_half(static_cast<float>(column.data()[i] / half.scale));
    half.numbers[static_cast<std::size_t>(i)] = number;
    error.data()[i] = half.scale * to_double(number) - column.data()[i];
  }
  half.error.entry = error.cwiseAbs().maxCoeff() / largest;
  half.error.compliance =
      error.colwise().sum().cwiseAbs().maxCoeff() / column.colwise().sum().cwiseAbs().maxCoeff();
  return half;
}

}  // namespace irdm
