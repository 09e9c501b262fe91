#include "device_bridge/safety/thermal_derating.hpp"

#include <algorithm>
#include <cmath>

namespace irdm {

void ThermalDerating::heat(double force, double elapsed, double reported) noexcept {
  const double load = force / limits_.continuous;
  if (std::isfinite(load)) {
    warmth_ += (load * load - warmth_) * -std::expm1(-elapsed / limits_.time_constant);
  }
  const double warmest = reported > warmth_ ? std::min(reported, 1.0) : warmth_;
  const double over = std::clamp((warmest - limits_.begin) / (1.0 - limits_.begin), 0.0, 1.0);
  const double lowest = std::min(limits_.continuous, limits_.peak);
  const double wanted = limits_.peak - over * (limits_.peak - lowest);
  const double change = limits_.slew * elapsed;
  limit_ = std::clamp(wanted, limit_ - change, limit_ + change);
}

}  // namespace irdm
