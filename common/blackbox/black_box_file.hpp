#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/blackbox/black_box.hpp"
#include "common/config/toml_reader.hpp"

namespace irdm {

/// Keys `black_box`, a folder, "" for none, and `black_box_files`, 1 to 1000. Throws Error.
BlackBoxSettings read_black_box(TomlTable& table);

/// Writes one black box into a folder, which is made when needed; the oldest ones of the same
/// program go, so that there are never more than `files`. It gets its name when it is whole.
/// Holds hdf5::library_mutex(). Throws Error.
std::filesystem::path write_black_box(const std::filesystem::path& folder, int files,
                                      const std::string& program, const Fault& fault,
                                      const std::vector<BlackBoxPart*>& parts);

}  // namespace irdm
