#pragma once

#include "common/hdf5/file.hpp"

namespace irdm::hdf5 {

/// Of a dataset or attribute; without dimensions of a single value.
/// @param maximum rows and columns that it may grow to; null: it does not grow
inline Handle make_space(const Shape& shape, const hsize_t* maximum = nullptr) {
  if (shape.empty()) return {H5Screate(H5S_SCALAR), H5Sclose};
  return {H5Screate_simple(static_cast<int>(shape.size()), shape.data(), maximum), H5Sclose};
}

}  // namespace irdm::hdf5
