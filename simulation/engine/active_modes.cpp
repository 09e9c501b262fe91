#include "simulation/engine/active_modes.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace irdm {
namespace {

// For each block, by how much it can move a node.
std::vector<double> block_bounds(std::span<const double> coordinate,
                                 std::span<const double> largest_shape) {
  std::vector<double> bounds((coordinate.size() + kModeBlock - 1) / kModeBlock, 0.0);
  for (std::size_t i = 0; i < coordinate.size(); ++i) {
    bounds[i / kModeBlock] += std::abs(coordinate[i]) * largest_shape[i];
  }
  return bounds;
}

std::vector<bool> kept_blocks(const std::vector<double>& bounds, double tolerance) {
  std::vector<std::size_t> weakest_first(bounds.size());
  std::iota(weakest_first.begin(), weakest_first.end(), std::size_t{0});
  std::stable_sort(weakest_first.begin(), weakest_first.end(),
                   [&](std::size_t a, std::size_t b) { return bounds[a] < bounds[b]; });
  std::vector<bool> kept(bounds.size(), true);
  double left_out = 0.0;
  for (const std::size_t block : weakest_first) {
    left_out += bounds[block];
    if (left_out > tolerance) break;
    kept[block] = false;
  }
  return kept;
}

}  // namespace

std::vector<ModeRange> active_modes(std::span<const double> coordinate,
                                    std::span<const double> largest_shape, double tolerance) {
  const std::vector<bool> kept = kept_blocks(block_bounds(coordinate, largest_shape), tolerance);
  std::vector<ModeRange> ranges;
  for (std::size_t block = 0; block < kept.size(); ++block) {
    if (!kept[block]) continue;
    const std::size_t first = block * kModeBlock;
    const std::size_t end = std::min(first + kModeBlock, coordinate.size());
    if (!ranges.empty() && ranges.back().first + ranges.back().count == first) {
      ranges.back().count += end - first;
    } else {
      ranges.push_back({first, end - first});
    }
  }
  return ranges;
}

}  // namespace irdm
