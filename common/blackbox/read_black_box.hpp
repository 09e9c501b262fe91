#pragma once

#include "common/blackbox/black_box.hpp"
#include "common/config/toml_reader.hpp"

namespace irdm {

/// Keys `black_box`, a folder, "" for none, and `black_box_files`, 1 to 1000. Throws Error.
BlackBoxSettings read_black_box(TomlTable& table);

}  // namespace irdm
