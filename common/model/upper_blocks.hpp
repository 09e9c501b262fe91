#pragma once

#include <cstdint>
#include <vector>

#include "common/model/model.hpp"

namespace irdm {

/// The blocks of a ResidualCompliance on and above the diagonal: as it is computed, and as a file
/// has it.
struct UpperBlocks {
  using Block = Eigen::Matrix<float, 3, 3, Eigen::RowMajor>;

  std::vector<std::int32_t> row_start = {0};  ///< (n + 1)
  std::vector<std::int32_t> nodes;  ///< of each block, increasing within a row from its own
  std::vector<float> blocks;        ///< 9 a block, rows first [m/N]

  int rows() const { return static_cast<int>(row_start.size()) - 1; }
  /// visit(row, column, block), in order.
  template <typename Visit>
  void for_each(const Visit& visit) const {
    for (int i = 0; i < rows(); ++i) {
      for (int k = row_start[static_cast<std::size_t>(i)];
           k < row_start[static_cast<std::size_t>(i) + 1]; ++k) {
        const auto place = static_cast<std::size_t>(k);
        visit(i, nodes[place], Eigen::Map<const Block>(blocks.data() + 9 * place));
      }
    }
  }
};

UpperBlocks upper_half(const ResidualCompliance& all);

/// The whole of it; its `reduction` is not filled.
ResidualCompliance both_halves(const UpperBlocks& upper);

}  // namespace irdm
