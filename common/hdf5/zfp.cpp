#include "common/hdf5/zfp.hpp"

namespace irdm::hdf5 {

bool compressed_by_zfp(const File& file, const std::string& dataset) {
  constexpr H5Z_filter_t kZfp = 32013;  // as in layout.cpp
  const Handle set(H5Dopen2(file.id(), dataset.c_str(), H5P_DEFAULT), H5Dclose);
  const Handle creation(H5Dget_create_plist(set.get()), H5Pclose);
  unsigned int flags = 0;
  std::size_t values = 0;
  return H5Pget_filter_by_id2(creation.get(), kZfp, &flags, &values, nullptr, 0, nullptr,
                              nullptr) >= 0;
}

}  // namespace irdm::hdf5
