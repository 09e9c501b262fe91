#pragma once

#include <string>

#include "common/hdf5/file.hpp"

namespace irdm::hdf5 {

/// Whether the numbers of a dataset were rounded when zfp compressed them.
bool compressed_by_zfp(const File& file, const std::string& dataset);

}  // namespace irdm::hdf5
