#pragma once

#include <memory>
#include <vector>

#include "replay/reference/fem_body.hpp"
#include "replay/rerun/rerun.hpp"
#include "replay/traced_scene.hpp"

namespace irdm::replay {

/// Longest sub-step of a reference, unless it is given [s]. See docs/replay.md.
inline constexpr double kReferenceSubstep = 2.5e-4;

/// Sub-steps are equal: the length of one, where `longest` is asked for and the server's is dt [s].
double fem_substep(double dt, double longest);

/// The same interaction by finite elements (FemBody): what the impulse
/// responses are measured against. Throws Error, naming the model that it cannot be done for.
/// @param substep [s], > 0
/// @param follow_tips held points follow their tips (FemBody)
/// @param delayed_forces of the trace, for all objects
/// @param journal of its steps, so that it can go on; null: none
std::unique_ptr<Rerun> fem_reference(const TracedScene& scene, precompute::Elasticity elasticity,
                                     double substep, bool follow_tips = false,
                                     const std::vector<DelayedForces>& delayed_forces = {},
                                     StepJournal* journal = nullptr);

}  // namespace irdm::replay
