#pragma once

#include "common/config/toml_reader.hpp"
#include "simulation/collision/scenery.hpp"

namespace irdm {

/// One [[scenery]] table. Throws Error with file and line.
SceneryConfig read_scenery(TomlTable table);

}  // namespace irdm
