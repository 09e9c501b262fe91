#pragma once

#include <vector>

#include "common/half.hpp"
#include "common/model/model.hpp"
#include "common/model/model_writer.hpp"

namespace irdm {

/// A column of R in half precision: R[s](a, b) = scale * numbers[s * 3n + a].
struct HalfColumn {
  std::vector<Half> numbers;
  double scale = 1.0;  ///< a power of two [m/N]
  HalfError error;     ///< of this column
};

/// @param column R[s](:, b), (T, 3n), finite [m/N]
HalfColumn half_column(const RowMatrix<double>& column);

}  // namespace irdm
