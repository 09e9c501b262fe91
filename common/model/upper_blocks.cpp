#include "common/model/upper_blocks.hpp"

namespace irdm {

UpperBlocks upper_half(const ResidualCompliance& all) {
  UpperBlocks upper;
  for (std::size_t i = 0; i + 1 < all.row_start.size(); ++i) {
    for (int k = all.row_start[i]; k < all.row_start[i + 1]; ++k) {
      const auto place = static_cast<std::size_t>(k);
      if (all.nodes[place] < static_cast<int>(i)) continue;
      upper.nodes.push_back(all.nodes[place]);
      const float* block = all.blocks.data() + 9 * place;
      upper.blocks.insert(upper.blocks.end(), block, block + 9);
    }
    upper.row_start.push_back(static_cast<std::int32_t>(upper.nodes.size()));
  }
  return upper;
}

// Rows are met in increasing order, so that each row's columns come out increasing.
ResidualCompliance both_halves(const UpperBlocks& upper) {
  ResidualCompliance all;
  all.row_start.assign(upper.row_start.size(), 0);
  upper.for_each([&](int i, int j, const auto&) {
    ++all.row_start[static_cast<std::size_t>(i) + 1];
    if (i != j) ++all.row_start[static_cast<std::size_t>(j) + 1];
  });
  for (std::size_t i = 1; i < all.row_start.size(); ++i) all.row_start[i] += all.row_start[i - 1];
  std::vector<int> next(all.row_start.begin(), all.row_start.end() - 1);
  all.nodes.resize(static_cast<std::size_t>(all.row_start.back()));
  all.blocks.resize(9 * all.nodes.size());
  const auto put = [&](int row, int column, const UpperBlocks::Block& block) {
    const auto place = static_cast<std::size_t>(next[static_cast<std::size_t>(row)]++);
    all.nodes[place] = column;
    Eigen::Map<UpperBlocks::Block>(all.blocks.data() + 9 * place) = block;
  };
  // Below the diagonal first: a row's columns before it come from rows that are met before it.
  upper.for_each([&](int i, int j, const auto& block) {
    put(i, j, block);
    if (i != j) put(j, i, block.transpose());
  });
  return all;
}

}  // namespace irdm
