#pragma once

#include <cstddef>
#include <optional>

namespace irdm::replay {

/// At the end of which steps of a run there is a frame: those that the times 1/rate, 2/rate, ...
/// fall into, up to the end of the run.
class FrameSteps {
 public:
  /// @param dt of a step [s], > 0
  /// @param rate frames a second [Hz], at most 1/dt; none: every step. Throws Error.
  FrameSteps(std::size_t steps, double dt, std::optional<double> rate);

  bool has(std::size_t step) const noexcept;
  /// All of them.
  std::size_t count() const noexcept;

 private:
  std::size_t frames_up_to(std::size_t steps) const noexcept;

  std::size_t steps_;
  double frames_in_step_;
};

}  // namespace irdm::replay
