#pragma once

#include <span>

#include "common/geometry.hpp"
#include "simulation/step/step_record.hpp"

namespace irdm::replay {

/// A run at the end of one step.
struct ReplayFrame {
  const StepRecord& record;
  std::span<const Points> displacement;  ///< of each object, (n, 3) [m], B; see needs_surfaces()
};

/// Takes in the frames of a run, in their order, and makes a file or a folder of them. What is not
/// finished leaves no file under its final name.
class FrameOutput {
 public:
  virtual ~FrameOutput() = default;

  /// Whether displacements are looked at: otherwise they may be missing.
  virtual bool needs_surfaces() const = 0;
  /// Throws Error when it cannot be written.
  virtual void put(const ReplayFrame& frame) = 0;
  /// After the last. Throws Error.
  virtual void finish() = 0;
};

}  // namespace irdm::replay
