#pragma once

#include "simulation/step/step_record.hpp"

namespace irdm::replay {

/// A recorded run that is made again, step by step. Pure; one thread.
class Rerun {
 public:
  virtual ~Rerun() = default;

  /// The next step. @param recorded as it is in the trace @param again as it comes out now
  virtual void step(const StepRecord& recorded, StepRecord& again) = 0;

  /// Of all surface nodes of object i at the end of the last step, (n, 3) [m], B.
  virtual void displacement(std::size_t i, Points& u) const = 0;
};

}  // namespace irdm::replay
