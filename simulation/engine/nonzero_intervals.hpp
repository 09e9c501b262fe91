#pragma once

#include <cstddef>
#include <vector>

#include "simulation/engine/force_history.hpp"

namespace irdm {

/// The forces on one degree of freedom over some consecutive ages.
struct NonzeroInterval {
  std::size_t column = 0;  ///< 3 node + axis
  std::size_t first_age = 0;
  std::size_t count = 0;
  const double* force = nullptr;  ///< force[i] acted `first_age + i` steps before the newest step
};

/// Silences shorter than this are read through: less than a page of R.
inline constexpr std::size_t kSilence = 64;

/// All of a history's forces, node by node and axis by axis, without the silences: directions in
/// which nothing acted, and steps between touches. Points into the history. Takes memory.
std::vector<NonzeroInterval> nonzero_intervals(const ForceHistory& history);

}  // namespace irdm
