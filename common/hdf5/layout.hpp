#pragma once

#include <vector>

#include "common/hdf5/handle.hpp"

namespace irdm::hdf5 {

using Shape = std::vector<hsize_t>;

/// How a dataset of fixed shape lies in the file.
struct Layout {
  Shape chunk = {};         ///< of the dataset's rank; empty: contiguous, without filters
  bool fletcher32 = false;  ///< a checksum a chunk, compared on every read
};

/// Creation properties of a dataset of that layout. Nothing in a file tells when it was made: the
/// same content gives the same bytes.
Handle dataset_properties(const Layout& layout);

}  // namespace irdm::hdf5
