#pragma once

#include <array>
#include <string>
#include <vector>

#include "simulation/step/simulation.hpp"

namespace irdm::test {

/// One second with a cube of 12 cm that a tether keeps in its place: what one or two styluses do to
/// it. Places, depths, speeds and fingertips differ from one to the next and are always the same.
struct Interaction {
  std::string kind;  ///< press, tap, slide, swing, pinch
  std::vector<SimulationStylus> styluses;
  std::array<Vector3, 2> place;     ///< where a tip meets the rest surface [m], W
  std::array<Vector3, 2> inward;    ///< unit, W
  Vector3 aside = Vector3::Zero();  ///< unit, along the surface
  double depth = 0.0;               ///< [m]
  double way = 0.0;                 ///< along the surface [m]
  double rate = 0.0;                ///< [1/s]

  /// Step k of `dt` [s].
  std::array<StylusCommand, 2> commands(int k, double dt) const;
};

inline constexpr int kInteractions = 50;

/// @param number 0 .. kInteractions - 1; each five after one another are the five kinds
Interaction interaction(int number);

/// Forces on the styluses, one row a step [N], W.
using ForceTrace = std::vector<std::array<Vector3, 2>>;
ForceTrace run_interaction(const Interaction& what, std::shared_ptr<const Model> model,
                           double seconds = 1.0);

struct ForceDifference {
  double peak = 0.0;     ///< of the force [N]
  double largest = 0.0;  ///< difference, share of the peak
  double rms = 0.0;      ///< difference, share of the force's root mean square
  int above = 0;         ///< steps in which it is more than a hundredth of the peak
};
ForceDifference compare(const ForceTrace& expected, const ForceTrace& actual);

}  // namespace irdm::test
