#pragma once

#include "common/hdf5/file.hpp"

namespace irdm {

/// Writes beside what a model file has what unit it is in (docs/files.md): attribute `unit` of
/// datasets, `units` of groups for their attributes. Once, when all is there.
void write_model_units(hdf5::File& file);

}  // namespace irdm
