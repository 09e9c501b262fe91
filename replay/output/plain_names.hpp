#pragma once

#include <string>
#include <vector>

#include "replay/traced_scene.hpp"

namespace irdm::replay {

/// Names of the objects for columns and files: letters, digits and - alone, the rest is _; no two
/// are the same.
std::vector<std::string> plain_names(const TracedScene& scene);

}  // namespace irdm::replay
