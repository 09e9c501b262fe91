#pragma once

#include <cstddef>
#include <limits>
#include <string>

#include "common/number_text.hpp"

namespace irdm {

/// Closed range of a number; the default is any finite number.
struct Range {
  double lowest = -std::numeric_limits<double>::max();
  double highest = std::numeric_limits<double>::max();
  bool lowest_included = true;
  bool highest_included = true;

  /// Never so for what is not finite.
  bool contains(double value) const noexcept;
};

constexpr Range above(double lowest) {
  return {.lowest = lowest, .lowest_included = false};
}
constexpr Range between(double lowest, double highest) {
  return {.lowest = lowest, .highest = highest};
}
/// From -largest to largest.
constexpr Range within(double largest) {
  return between(-largest, largest);
}

/// For messages: "a finite number >= 0 and <= 10".
std::string describe(const Range& range);
/// The value as text, with all digits where fewer would show a bound that it is not.
std::string exact_text(const Range& range, double value);
/// "is 2, not a finite number <= 1", of a value outside (exact_text()).
std::string outside_text(const Range& range, double value);

}  // namespace irdm

/// Ranges that no laboratory leaves: what configurations of models and scenes, model files and
/// traces may say. Wide on purpose; they keep every product and quotient of the force step a finite
/// number. The same table is in docs/configuration.md; what concerns files alone, in docs/files.md.
namespace irdm::lab {

// Model's configuration.
inline constexpr Range kStepTime = between(1e-5, 1.0);       ///< dt [s]
inline constexpr Range kYoungsModulus = between(1.0, 1e13);  ///< [Pa]
inline constexpr Range kPoissonRatio{-1.0, 0.5, false, false};
inline constexpr Range kDensity = between(0.01, 1e5);        ///< [kg/m^3]
inline constexpr Range kRayleighAlpha = between(0.0, 1e6);   ///< [1/s]
inline constexpr Range kRayleighBeta = between(0.0, 100.0);  ///< [s]
inline constexpr Range kLength = between(1e-6, 1e4);         ///< of edges and radii [m]
inline constexpr Range kMeshPlace = within(1e6);             ///< in a mesh's coordinates [m]
inline constexpr Range kFrequency{0.0, 1e9, false};          ///< [Hz]
inline constexpr Range kProbeForce{0.0, 1e9, false};         ///< of time stepping [N]
inline constexpr int kMostSteps = 1'000'000;                 ///< T

// Model file, beside what its configuration says.
inline constexpr Range kMass = between(1e-15, 1e12);          ///< of the body [kg]
inline constexpr Range kExtent = between(1e-7, 1e6);          ///< from its centre of mass [m]
inline constexpr Range kModeFrequency = between(1e-9, 1e15);  ///< angular [rad/s]
inline constexpr Range kDecayRate = between(0.0, 1e30);       ///< of a mode [1/s]
inline constexpr Range kCompliance = within(1e12);            ///< R, and sums of it [m/N]

// Scene.
inline constexpr Range kPlace = within(1e4);            ///< [m], W
inline constexpr Range kVelocity = within(1e3);         ///< [m/s], W
inline constexpr Range kAngularVelocity = within(1e3);  ///< [rad/s], W
inline constexpr Range kGravity = within(100.0);        ///< of each component [m/s^2]
inline constexpr Range kFriction = between(0.0, 10.0);
inline constexpr Range kDamping = between(0.0, 100.0);         ///< of a rigid motion [1/s]
inline constexpr Range kStiffness = between(0.0, 1e9);         ///< [N/m], [N m/rad]
inline constexpr Range kMaterialDamping = between(0.1, 10.0);  ///< times the model's
inline constexpr Range kTipLength = between(0.0, 1.0);         ///< radius and reach of a tip [m]

/// Of a trace: forces, places, velocities and so on, each in its unit.
inline constexpr Range kRecorded = within(1e15);

/// Of directions and quaternions of any length, whose square has to be a number.
inline constexpr Range kComponent = within(1e100);
inline constexpr std::size_t kLongestName = 100;   ///< of an object [byte]
inline constexpr std::size_t kLongestText = 4096;  ///< of any other text [byte]

}  // namespace irdm::lab
