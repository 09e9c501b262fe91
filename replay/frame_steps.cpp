#include "replay/frame_steps.hpp"

#include <cmath>
#include <string>

#include "common/error.hpp"

namespace irdm::replay {

FrameSteps::FrameSteps(std::size_t steps, double dt, std::optional<double> rate)
    : steps_(steps), frames_in_step_(rate ? *rate * dt : 1.0) {
  constexpr double kRounding = 1e-9;
  if (frames_in_step_ <= 1.0 + kRounding) return;
  throw Error("--rate", "is above the rate of the steps",
              "use at most " + std::to_string(1.0 / dt) + " Hz, or leave it out for every step");
}

// Frame j = 1, 2, ... is in step k = 0, 1, ... when k < j / frames_in_step <= k + 1.
std::size_t FrameSteps::frames_up_to(std::size_t steps) const noexcept {
  constexpr double kRounding = 1e-6;
  return static_cast<std::size_t>(
      std::floor(static_cast<double>(steps) * frames_in_step_ + kRounding));
}

bool FrameSteps::has(std::size_t step) const noexcept {
  return frames_up_to(step + 1) > frames_up_to(step);
}

std::size_t FrameSteps::count() const noexcept {
  return frames_up_to(steps_);
}

}  // namespace irdm::replay
