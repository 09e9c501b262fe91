#pragma once

#include <cstddef>
#include <vector>

#include "trace/recording.hpp"

namespace irdm::replay {

/// A force that a bridge told of after its step.
struct DelayedForces {
  std::size_t step = 0;  ///< that it belongs to, from the start of the trace
  LateForce late;
  Quaternion orientation =
      Quaternion::Identity();  ///< of the recorded body half-way through that step
};

/// What bridges told too late, by the steps that it belongs to. What belongs to a time before the
/// trace, or before a reset, is left out, as in the server.
std::vector<DelayedForces> delayed_forces(const Recording& recording);

/// What acted on the styluses in the end: adds to their forces what was told late for a step.
/// @param told of delayed_forces()  @param step of the trace, that the record is of
/// @param held_anew the forces of what is held were found anew, so that they have it already
void add_delayed_forces(const std::vector<DelayedForces>& told, std::size_t step, bool held_anew,
                        StepRecord& record);

}  // namespace irdm::replay
