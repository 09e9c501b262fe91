#pragma once

#include <cstdint>
#include <string>

#include "tests/prediction/delayed_loop.hpp"

namespace irdm::test {

/// A hand, an object and a link of any kind within what must hold (docs/architecture.md): hands of
/// 0.05 to 0.3 kg, loose to firm; E from 1e3 to 1e6 N/m^2, touching or grabbed, free or tethered;
/// round trip 0 to 20 ms, jitter to 10 ms, loss to 5 %. Behind the safety filter.
struct RandomLoop {
  /// @param near round trip of at most 2 ms, jitter included, and a coupling of at most 400 N/m
  explicit RandomLoop(std::uint64_t seed, bool near = false);

  LoopSetup setup;
  LoopLink link;
  std::string words;  ///< for a message
};

/// The motion of the hand when what it wants has come to rest.
struct Unrest {
  double speed = 0.0;  ///< root mean square over the last 0.2 s [m/s]
};
Unrest unrest(const LoopRun& run, double dt);

}  // namespace irdm::test
