#pragma once

#include <cstdint>
#include <string>

#include "tests/prediction/delayed_loop.hpp"

namespace irdm::test {

/// One to four hands with a cube of 1e3 to 1e6 N/m^2, over links and on machines that are bad: 0 to
/// 20 ms one way, jitter to 10 ms, loss to 10 %, overruns to 20 ms at either side. Each presses,
/// slides or grabs and swings, on a face of its own; one hand alone perhaps on a cube that lies on
/// a floor. The contact is solved at the bridges, behind safety filters.
struct HarshLoop {
  explicit HarshLoop(std::uint64_t seed);

  LoopSetup setup;
  LoopLink link;
  std::string words;  ///< for a message
};

}  // namespace irdm::test
