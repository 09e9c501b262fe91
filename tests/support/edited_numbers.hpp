#pragma once

#include <hdf5.h>

#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/hdf5/handle.hpp"

namespace irdm::test {

/// Changes the numbers of a dataset of a file, whatever their type.
inline void edit_numbers(const std::filesystem::path& path, const std::string& set,
                         const std::function<void(std::vector<double>&)>& change) {
  using hdf5::Handle;
  const Handle file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
  const Handle data(H5Dopen2(file.get(), set.c_str(), H5P_DEFAULT), H5Dclose);
  if (data.get() < 0) throw std::runtime_error("there is no " + set);
  const Handle space(H5Dget_space(data.get()), H5Sclose);
  std::vector<double> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space.get())));
  H5Dread(data.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  change(values);
  if (H5Dwrite(data.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) {
    throw std::runtime_error("cannot write " + set);
  }
}

/// Gives one of them another value.
inline void set_number(const std::filesystem::path& path, const std::string& set, std::size_t place,
                       double value) {
  edit_numbers(path, set, [&](std::vector<double>& values) { values.at(place) = value; });
}

/// Gives an attribute of one number another value.
inline void set_attribute(const std::filesystem::path& path, const std::string& object,
                          const std::string& name, double value) {
  using hdf5::Handle;
  const Handle file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
  const Handle attribute(
      H5Aopen_by_name(file.get(), object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT),
      H5Aclose);
  if (attribute.get() < 0 || H5Awrite(attribute.get(), H5T_NATIVE_DOUBLE, &value) < 0) {
    throw std::runtime_error("cannot write " + name + " of " + object);
  }
}

}  // namespace irdm::test
