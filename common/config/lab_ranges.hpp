#pragma once

#include <cstddef>

#include "common/config/range.hpp"

/// Ranges that no laboratory leaves: what configurations of models and scenes may say. Wide on
/// purpose; they keep every product and quotient of the force step a finite number. The same table
/// is in docs/configuration.md.
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

// Scene.
inline constexpr Range kPlace = within(1e4);            ///< [m], W
inline constexpr Range kVelocity = within(1e3);         ///< [m/s], W
inline constexpr Range kAngularVelocity = within(1e3);  ///< [rad/s], W
inline constexpr Range kGravity = within(100.0);        ///< of each component [m/s^2]
inline constexpr Range kFriction = between(0.0, 10.0);
inline constexpr Range kDamping = between(0.0, 100.0);  ///< of a rigid motion [1/s]
inline constexpr Range kStiffness = between(0.0, 1e9);  ///< [N/m], [N m/rad]
inline constexpr Range kTipLength = between(0.0, 1.0);  ///< radius and reach of a tip [m]
/// Of directions and quaternions of any length, whose square has to be a number.
inline constexpr Range kComponent = within(1e100);
inline constexpr std::size_t kLongestName = 100;   ///< of an object [byte]
inline constexpr std::size_t kLongestText = 4096;  ///< of any other text [byte]

}  // namespace irdm::lab
