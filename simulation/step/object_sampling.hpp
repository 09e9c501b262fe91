#pragma once

#include <memory>

#include "simulation/contact/contact_sampling.hpp"
#include "simulation/step/simulation_config.hpp"

namespace irdm {

/// Returns the samples of an object's surface for contacts with other bodies: `contact_samples`
/// patches, samples for the balls of styluses, and on a soft object those for the balls of the
/// scenery. The result depends only on the scene and the model, so that sample numbers in a trace
/// keep their meaning.
/// @param surface the model's surface; it must outlive the result
std::unique_ptr<ContactSampling> make_sampling(const SimulationConfig& config, const Model& model,
                                               const RestSurface& surface);

}  // namespace irdm
