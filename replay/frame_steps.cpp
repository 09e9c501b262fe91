#include "replay/frame_steps.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "common/error.hpp"

namespace irdm::replay {

FrameSteps::FrameSteps(std::size_t steps, double dt, std::optional<double> rate,
                       const RunPart& part)
    : frames_in_step_(rate ? *rate * dt : 1.0) {
  constexpr double kRounding = 1e-9;
  if (frames_in_step_ > 1.0 + kRounding) {
    throw Error("--rate", "is above the rate of the steps",
                "use at most " + std::to_string(1.0 / dt) + " Hz, or leave it out for every step");
  }
  const double length = static_cast<double>(steps);
  first_ = static_cast<std::size_t>(
      std::clamp(std::ceil(part.begin / dt - kRounding) - 1.0, 0.0, length));
  end_ = static_cast<std::size_t>(std::min(std::floor(part.end / dt + kRounding), length));
  if (steps == 0 || first_ < end_) return;
  throw Error("--begin, --end",
              "leave out all of the run, which is " + std::to_string(length * dt) + " s long",
              "give times within it, the first below the second");
}

// Frame j = 1, 2, ... is in step k = 0, 1, ... when k < j / frames_in_step <= k + 1.
std::size_t FrameSteps::frames_up_to(std::size_t steps) const noexcept {
  constexpr double kRounding = 1e-6;
  return static_cast<std::size_t>(
      std::floor(static_cast<double>(steps) * frames_in_step_ + kRounding));
}

bool FrameSteps::has(std::size_t step) const noexcept {
  return step >= first_ && step < end_ && frames_up_to(step + 1) > frames_up_to(step);
}

std::size_t FrameSteps::count() const noexcept {
  return frames_up_to(end_) - frames_up_to(first_);
}

}  // namespace irdm::replay
