#pragma once

#include <string>
#include <vector>

#include "common/hdf5/handle.hpp"

namespace irdm::hdf5 {

using Shape = std::vector<hsize_t>;

/// How a dataset of fixed shape lies in the file.
struct Layout {
  Shape chunk = {};         ///< of the dataset's rank; empty: contiguous, without filters
  bool fletcher32 = false;  ///< a checksum a chunk, compared on every read
  /// Above 0: compressed by zfp with at most this error of a number, in its unit. Needs HDF5's zfp
  /// plugin (Debian: hdf5-filter-plugin-zfp-serial) to write and to read.
  double zfp_accuracy = 0.0;
};

/// Whether HDF5 finds its zfp plugin.
bool zfp_available();

/// Creation properties of a dataset of that layout. Nothing in a file tells when it was made: the
/// same content gives the same bytes. Throws Error when a filter is missing.
/// @param file its name, for the message
Handle dataset_properties(const Layout& layout, const std::string& file);

/// Throws Error when the dataset needs a filter that HDF5 does not find here: HDF5 itself would
/// only say that the data cannot be read.
/// @param file, path names for the message
void check_filters(const Handle& dataset, const std::string& file, const std::string& path);

}  // namespace irdm::hdf5
