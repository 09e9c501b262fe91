#pragma once

#include <string>
#include <vector>

#include "simulation/step/step_record.hpp"

namespace irdm::replay {

/// Whether every number that a step did is finite.
bool is_finite(const StepRecord& record);

/// Throws Error unless a step that was made again is finite: forces of a damaged trace, or of
/// another model, may drive an object beyond all numbers.
/// @param trace its name
void require_finite(const StepRecord& again, const std::string& trace);
/// The same of the displacements of all objects.
void require_finite(const std::vector<Points>& displacements, const std::string& trace);

}  // namespace irdm::replay
