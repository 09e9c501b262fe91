#pragma once

#include <cstddef>
#include <limits>
#include <optional>

namespace irdm::replay {

/// A part of a run, the ends included [s].
struct RunPart {
  double begin = 0.0;
  double end = std::numeric_limits<double>::infinity();
};

/// At the end of which steps of a run there is a frame: those that the times 1/rate, 2/rate, ...
/// fall into, up to the end of the run, as far as these steps end in a part of it.
class FrameSteps {
 public:
  /// @param dt of a step [s], > 0
  /// @param rate frames a second [Hz], at most 1/dt; none: every step. Throws Error.
  FrameSteps(std::size_t steps, double dt, std::optional<double> rate, const RunPart& part = {});

  bool has(std::size_t step) const noexcept;
  /// All of them.
  std::size_t count() const noexcept;

 private:
  std::size_t frames_up_to(std::size_t steps) const noexcept;

  double frames_in_step_;
  std::size_t first_;  // step of the part
  std::size_t end_;    // one behind its last
};

}  // namespace irdm::replay
