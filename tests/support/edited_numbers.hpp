#pragma once

#include <hdf5.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/hdf5/handle.hpp"
#include "common/model/content_checksum.hpp"
#include "common/model/model_writer.hpp"

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

/// Gives a set another type; `offset` is added to its numbers.
inline void retype(const std::filesystem::path& path, const std::string& set, hid_t type,
                   double offset = 0.0) {
  using hdf5::Handle;
  const Handle file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
  Handle data(H5Dopen2(file.get(), set.c_str(), H5P_DEFAULT), H5Dclose);
  const Handle space(H5Dget_space(data.get()), H5Sclose);
  std::vector<double> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space.get())));
  H5Dread(data.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  for (double& value : values) value += offset;
  data = Handle();
  H5Ldelete(file.get(), set.c_str(), H5P_DEFAULT);
  data = Handle(
      H5Dcreate2(file.get(), set.c_str(), type, space.get(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
      H5Dclose);
  if (H5Dwrite(data.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) {
    throw std::runtime_error("cannot write " + set);
  }
}

/// Puts an attribute in the place of another one: a text, or a number in double precision.
inline void replace_attribute(const std::filesystem::path& path, const std::string& object,
                              const std::string& name, const std::string& text) {
  using hdf5::Handle;
  const Handle file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
  const Handle owner(H5Oopen(file.get(), object.c_str(), H5P_DEFAULT), H5Oclose);
  H5Adelete(owner.get(), name.c_str());
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.get(), text.size());
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle made(
      H5Acreate2(owner.get(), name.c_str(), type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT),
      H5Aclose);
  if (H5Awrite(made.get(), type.get(), text.data()) < 0) {
    throw std::runtime_error("cannot write " + name);
  }
}
inline void replace_attribute(const std::filesystem::path& path, const std::string& object,
                              const std::string& name, double number) {
  using hdf5::Handle;
  const Handle file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
  const Handle owner(H5Oopen(file.get(), object.c_str(), H5P_DEFAULT), H5Oclose);
  H5Adelete(owner.get(), name.c_str());
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle made(H5Acreate2(owner.get(), name.c_str(), H5T_NATIVE_DOUBLE, space.get(),
                               H5P_DEFAULT, H5P_DEFAULT),
                    H5Aclose);
  if (H5Awrite(made.get(), H5T_NATIVE_DOUBLE, &number) < 0) {
    throw std::runtime_error("cannot write " + name);
  }
}

/// Takes a set, a group or an attribute of the root away.
inline void take_away(const std::filesystem::path& path, const std::string& name) {
  const hdf5::Handle file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
  const bool link = name.front() == '/';
  if ((link ? H5Ldelete(file.get(), name.c_str(), H5P_DEFAULT)
            : H5Adelete(file.get(), name.c_str())) < 0) {
    throw std::runtime_error("there is no " + name);
  }
}

/// Gives a model file whose numbers were edited the checksums of what it now holds.
inline void sign_model(const std::filesystem::path& path) {
  std::vector<std::uint64_t> columns;
  {
    const auto file = hdf5::File::open(path);
    if (file.exists(kDenseColumnChecksum)) {
      const hdf5::Shape shape = file.shape(kDenseR);
      const bool single = file.element_size(kDenseR) == sizeof(float);
      const std::size_t size = shape.at(1) * shape.at(2);
      for (hsize_t b = 0; b < shape[0]; ++b) {
        std::vector<double> column(size);
        file.read_slab<double>(kDenseR, {b, 0, 0}, {1, shape[1], shape[2]}, column.data());
        const std::vector<float> stored(column.begin(), column.end());
        columns.push_back(single ? number_checksum(stored.data(), size)
                                 : number_checksum(column.data(), size));
      }
    }
  }
  if (!columns.empty()) {
    const hdf5::Handle file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
    const hdf5::Handle set(H5Dopen2(file.get(), kDenseColumnChecksum, H5P_DEFAULT), H5Dclose);
    H5Dwrite(set.get(), H5T_NATIVE_UINT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, columns.data());
  }
  const auto checksum = [&] { return content_checksum(hdf5::File::open(path)); }();
  replace_attribute(path, "/", "content_sha256", checksum);
}

}  // namespace irdm::test
