#include "common/hdf5/layout.hpp"

namespace irdm::hdf5 {

Handle dataset_properties(const Layout& layout) {
  Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(properties.get(), 0);
  if (layout.chunk.empty()) return properties;
  H5Pset_chunk(properties.get(), static_cast<int>(layout.chunk.size()), layout.chunk.data());
  if (layout.fletcher32) H5Pset_fletcher32(properties.get());
  return properties;
}

}  // namespace irdm::hdf5
