#pragma once

#include <cstdint>

#include "common/geometry.hpp"

namespace irdm {

/// How a device measures where its stylus is. The defaults are a perfect one.
struct SensorParameters {
  double resolution = 0.0;  ///< of each coordinate in D [m], >= 0; 0: exact. A Touch: 5.5e-5
  double noise = 0.0;       ///< standard deviation of each coordinate [m], >= 0
  std::uint32_t seed = 1;   ///< of the noise: the same seed, the same noise
};

/// Adds noise to a position and rounds it as encoders do; evenly in space, where those of a real
/// arm are in its joints. Depends on the seed and the number of readings before, on nothing else.
/// Real-time safe.
class VirtualSensor {
 public:
  explicit VirtualSensor(const SensorParameters& parameters) : parameters_(parameters) {}

  /// The next reading [m], D.
  Vector3 measure(const Vector3& tip) noexcept;

 private:
  double next_normal() noexcept;

  SensorParameters parameters_;
  std::uint64_t drawn_ = 0;
};

}  // namespace irdm
