#pragma once

#include <hdf5.h>

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/hdf5/handle.hpp"

namespace irdm::test {

/// Puts a dataset in the place of another one of a file: one that has any shape, and no number in
/// the file.
inline void make_sparse(const std::filesystem::path& path, const std::string& set,
                        const std::vector<hsize_t>& shape) {
  using hdf5::Handle;
  const int rank = static_cast<int>(shape.size());
  const std::vector<hsize_t> chunk(shape.size(), 1);
  const Handle file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
  const Handle space(H5Screate_simple(rank, shape.data(), nullptr), H5Sclose);
  const Handle sparse(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_chunk(sparse.get(), rank, chunk.data());
  H5Ldelete(file.get(), set.c_str(), H5P_DEFAULT);
  const Handle made(H5Dcreate2(file.get(), set.c_str(), H5T_NATIVE_INT32, space.get(), H5P_DEFAULT,
                               sparse.get(), H5P_DEFAULT),
                    H5Dclose);
  if (made.get() < 0) throw std::runtime_error("cannot make " + set);
}

}  // namespace irdm::test
