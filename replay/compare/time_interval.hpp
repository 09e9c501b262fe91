#pragma once

#include <cstddef>
#include <vector>

namespace irdm::replay {

/// Frames that follow each other.
struct TimeInterval {
  std::size_t first = 0;
  std::size_t count = 0;
};

/// The longest one in which all frames are marked; the first of equal ones.
TimeInterval longest_stretch(const std::vector<bool>& marked);

/// Whether times are as far from each other everywhere, within a hundredth.
bool evenly_spaced(const std::vector<double>& times);

}  // namespace irdm::replay
