#include "device_bridge/virtual_sensor.hpp"

#include <cmath>
#include <numbers>

namespace irdm {
namespace {

// A well-mixed function of its argument (splitmix64): numbers in a row give numbers at random.
std::uint64_t mix(std::uint64_t x) noexcept {
  x += 0x9E3779B97F4A7C15;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EB;
  return x ^ (x >> 31);
}

// Evenly in (0, 1].
double uniform(std::uint64_t x) noexcept {
  constexpr double kUnit = 0x1p-53;
  return kUnit * static_cast<double>((mix(x) >> 11) + 1);
}

}  // namespace

// Box and Muller's pair, of which one is enough.
double VirtualSensor::next_normal() noexcept {
  const std::uint64_t stream = std::uint64_t{parameters_.seed} << 32;
  const double radius = std::sqrt(-2.0 * std::log(uniform(mix(stream) + drawn_)));
  const double angle = 2.0 * std::numbers::pi * uniform(mix(stream) + drawn_ + 1);
  drawn_ += 2;
  return radius * std::cos(angle);
}

Vector3 VirtualSensor::measure(const Vector3& tip) noexcept {
  const auto& [resolution, noise, seed] = parameters_;
  Vector3 measured = tip;
  if (noise > 0.0) {
    for (double& coordinate : measured) coordinate += noise * next_normal();
  }
  if (resolution > 0.0) {
    for (double& coordinate : measured) {
      coordinate = resolution * std::round(coordinate / resolution);
    }
  }
  return measured;
}

}  // namespace irdm
