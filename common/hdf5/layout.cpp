#include "common/hdf5/layout.hpp"

#include <array>
#include <cstring>

#include "common/error.hpp"

namespace irdm::hdf5 {
namespace {

// Registered at the HDF Group for H5Z-ZFP; its parameters as that filter's documentation has them.
constexpr H5Z_filter_t kZfp = 32013;
constexpr unsigned kZfpAccuracyMode = 3;
constexpr const char* kZfpRemedy = "install HDF5's zfp plugin (hdf5-filter-plugin-zfp-serial)";

std::array<unsigned, 4> zfp_parameters(double accuracy) {
  std::array<unsigned, 4> values{kZfpAccuracyMode, 0, 0, 0};
  std::memcpy(&values[2], &accuracy, sizeof accuracy);
  return values;
}

}  // namespace

bool zfp_available() {
  prepare_library();
  return H5Zfilter_avail(kZfp) > 0;
}

Handle dataset_properties(const Layout& layout, const std::string& file) {
  Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(properties.get(), 0);
  if (layout.chunk.empty()) return properties;
  H5Pset_chunk(properties.get(), static_cast<int>(layout.chunk.size()), layout.chunk.data());
  if (layout.zfp_accuracy > 0.0) {
    if (!zfp_available()) {
      throw Error(file, "cannot be compressed: HDF5 has no zfp filter here", kZfpRemedy);
    }
    const std::array<unsigned, 4> values = zfp_parameters(layout.zfp_accuracy);
    H5Pset_filter(properties.get(), kZfp, H5Z_FLAG_MANDATORY, values.size(), values.data());
  }
  if (layout.fletcher32) H5Pset_fletcher32(properties.get());  // of what is compressed already
  return properties;
}

void check_filters(const Handle& dataset, const std::string& file, const std::string& path) {
  const Handle creation(H5Dget_create_plist(dataset.get()), H5Pclose);
  for (int i = 0; i < H5Pget_nfilters(creation.get()); ++i) {
    std::size_t no_values = 0;
    const H5Z_filter_t filter = H5Pget_filter2(creation.get(), static_cast<unsigned>(i), nullptr,
                                               &no_values, nullptr, 0, nullptr, nullptr);
    if (H5Zfilter_avail(filter) > 0) continue;
    if (filter == kZfp) {
      throw Error(file, path + " is compressed by zfp and HDF5 has no zfp filter here", kZfpRemedy);
    }
    throw Error(file, path + " needs HDF5's filter " + std::to_string(filter),
                "install the plugin that has it");
  }
}

}  // namespace irdm::hdf5
