#pragma once

#include <cstdint>
#include <vector>

#include "common/hdf5/file.hpp"
#include "simulation/step/simulation_config.hpp"
#include "simulation/step/step_record.hpp"

namespace irdm::trace {

/// Contacts of objects with each other and with scenery, by their step.
struct BodyContactRows {
  std::vector<std::uint64_t> force_step;
  std::vector<BodyContactRecord> contact;
};

/// Reads them whole and checks them against the scene and its models. None in a trace of a scene
/// without such contacts, or in an older one: that is no error. Throws Error.
/// @param last_step that counts: a server that was killed may leave rows of later ones
BodyContactRows read_body_contacts(const hdf5::File& file, const SimulationConfig& config,
                                   std::uint64_t last_step);

}  // namespace irdm::trace
