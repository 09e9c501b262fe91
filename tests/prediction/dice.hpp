#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <random>

#include "tests/support/fem_cube.hpp"

/// What random loops are made of.
namespace irdm::test {

inline constexpr double kHalfEdge = 0.06;  ///< of the cube [m]

/// From 0 to 1 while t goes from `from` to `to`, without jerks.
inline double smooth(double t, double from, double to) {
  const double s = std::clamp((t - from) / (to - from), 0.0, 1.0);
  return s * s * (3 - 2 * s);
}

class Dice {
 public:
  explicit Dice(std::uint64_t seed) : random_(seed) {}
  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(random_() >> 11) * 0x1p-53;
  }
  /// Evenly over the orders of magnitude.
  double over(double low, double high) { return low * std::pow(high / low, between(0.0, 1.0)); }
  bool coin() { return between(0.0, 1.0) < 0.5; }

 private:
  std::mt19937_64 random_;
};

/// Models of a few stiffnesses, 1e3 to 1e6 N/m^2, serve all loops.
inline std::shared_ptr<const Model> cube_of(std::size_t which) {
  constexpr std::array kStiffnesses{1e3, 3e3, 1e4, 3e4, 1e5, 3e5, 1e6};
  static std::mutex mutex;
  static std::map<std::size_t, std::shared_ptr<const Model>> made;
  const std::lock_guard lock(mutex);
  auto& model = made[which % kStiffnesses.size()];
  if (!model) {
    model = fem_cube({.cells = 3, .youngs_modulus = kStiffnesses[which % kStiffnesses.size()]},
                     ResponseKind::kModal);
  }
  return model;
}

}  // namespace irdm::test
