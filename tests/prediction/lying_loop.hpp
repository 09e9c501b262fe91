#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "tests/prediction/delayed_loop.hpp"

namespace irdm::test {

/// One or two honest hands with a cube of 1e3 to 1e6 N/m^2, and one to four peers that lie about
/// tips, pump, or exert what they like, up to 40 N. All contacts are solved at bridges; the honest
/// ones have safety filters. Some of the loops have stalls of up to 20 ms at server and bridges.
struct LyingLoop {
  explicit LyingLoop(std::uint64_t seed);

  LoopSetup setup;
  LoopLink link;
  std::size_t honest = 0;  ///< the first hands
  bool stalls = false;
  std::string words;  ///< for a message
};

}  // namespace irdm::test
