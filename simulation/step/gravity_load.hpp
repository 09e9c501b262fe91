#pragma once

#include "simulation/step/simulation_config.hpp"

namespace irdm {

/// Makes gravity bend an object as it is set [m/s^2], W. Only a fixed one, which stays as it stood
/// at the start: gravity alone does not bend what floats, and what it rests on or hangs from does
/// so by its force. Real-time safe.
/// @param engine of the object
void follow_gravity(ResponseEngine& engine, const SimulationObject& object,
                    const Vector3& gravity) noexcept;

/// Whether gravity can bend the object as far as that is up to it: it floats, or its response says
/// what gravity does to it.
bool takes_gravity(const SimulationObject& object);

}  // namespace irdm
