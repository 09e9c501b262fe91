// Attributes of a file's groups and datasets.
#include <algorithm>

#include "common/error.hpp"
#include "common/hdf5/file.hpp"

namespace irdm::hdf5 {

bool File::has_attribute(const std::string& object, const std::string& name) const {
  return H5Aexists_by_name(file_.get(), object.c_str(), name.c_str(), H5P_DEFAULT) > 0;
}

void File::write_attribute(const std::string& object, const std::string& name,
                           const std::string& value) {
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.get(), std::max<std::size_t>(value.size(), 1));
  H5Tset_strpad(type.get(), H5T_STR_NULLPAD);
  H5Tset_cset(type.get(), H5T_CSET_UTF8);
  write_numbers(object, name, type.get(), {}, value.empty() ? "\0" : value.data());
}

void File::write_attribute(const std::string& object, const std::string& name, double value) {
  write_numbers(object, name, H5T_NATIVE_DOUBLE, {}, &value);
}

void File::write_attribute(const std::string& object, const std::string& name, std::int64_t value) {
  write_numbers(object, name, H5T_NATIVE_INT64, {}, &value);
}

void File::write_attribute(const std::string& object, const std::string& name, const Shape& shape,
                           const double* values) {
  write_numbers(object, name, H5T_NATIVE_DOUBLE, shape, values);
}

void File::write_numbers(const std::string& object, const std::string& name, hid_t type,
                         const Shape& shape, const void* values) {
  const Handle owner = open_object(object);
  // Without dimensions it is that of a single value.
  const Handle space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr),
                     H5Sclose);
  const Handle attribute(
      H5Acreate2(owner.get(), name.c_str(), type, space.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  if (attribute.get() < 0 || H5Awrite(attribute.get(), type, values) < 0) {
    fail_write("cannot write attribute " + name);
  }
}

std::string File::read_string_attribute(const std::string& object, const std::string& name) const {
  const Handle owner = open_object(object);
  const Handle attribute(H5Aopen(owner.get(), name.c_str(), H5P_DEFAULT), H5Aclose);
  if (attribute.get() < 0) fail_read("has no attribute " + name + " at " + object);
  const Handle stored(H5Aget_type(attribute.get()), H5Tclose);
  if (H5Tget_class(stored.get()) != H5T_STRING) fail_read("attribute " + name + " is not text");
  // H5Aread writes one value for each point of the attribute's space.
  const Handle space(H5Aget_space(attribute.get()), H5Sclose);
  if (H5Sget_simple_extent_npoints(space.get()) != 1) {
    fail_read("attribute " + name + " of " + object + " is not one text");
  }
  if (H5Tis_variable_str(stored.get()) > 0) {  // as h5py writes it
    char* text = nullptr;
    const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(type.get(), H5T_VARIABLE);
    H5Tset_cset(type.get(), H5Tget_cset(stored.get()));
    if (H5Aread(attribute.get(), type.get(), &text) < 0 || text == nullptr) {
      fail_read("attribute " + name + " cannot be read");
    }
    std::string value(text);
    H5free_memory(text);
    return value;
  }
  std::string value(H5Tget_size(stored.get()), '\0');
  if (H5Aread(attribute.get(), stored.get(), value.data()) < 0) {
    fail_read("attribute " + name + " cannot be read");
  }
  value.resize(std::min(value.size(), value.find('\0')));
  return value;
}

void File::require_text(const std::string& object, const std::string& name,
                        const std::string& expected) const {
  if (!has_attribute(object, name)) return;
  const std::string found = read_string_attribute(object, name);
  if (found == expected) return;
  fail_read("attribute " + name + " of " + object + " is " + in_quotes(found) + ", not " +
            in_quotes(expected));
}

void File::read_numbers(const std::string& object, const std::string& name, hid_t type,
                        std::size_t count, void* values) const {
  const Handle owner = open_object(object);
  const Handle attribute(H5Aopen(owner.get(), name.c_str(), H5P_DEFAULT), H5Aclose);
  if (attribute.get() < 0) fail_read("has no attribute " + name + " at " + object);
  const Handle stored(H5Aget_type(attribute.get()), H5Tclose);
  const H5T_class_t kind = H5Tget_class(stored.get());
  const Handle space(H5Aget_space(attribute.get()), H5Sclose);
  if (kind == H5T_FLOAT && H5Tget_class(type) == H5T_INTEGER) {
    fail_read("attribute " + name + " at " + object + " is not an integer");
  }
  if ((kind != H5T_FLOAT && kind != H5T_INTEGER) ||
      H5Sget_simple_extent_npoints(space.get()) != static_cast<hssize_t>(count)) {
    fail_read("attribute " + name + " at " + object + " is not " + std::to_string(count) +
              " number(s)");
  }
  if (H5Aread(attribute.get(), type, values) < 0) {
    fail_read("attribute " + name + " cannot be read");
  }
}

double File::read_double_attribute(const std::string& object, const std::string& name) const {
  double value = 0.0;
  read_numbers(object, name, H5T_NATIVE_DOUBLE, 1, &value);
  return value;
}

std::int64_t File::read_integer_attribute(const std::string& object,
                                          const std::string& name) const {
  std::int64_t value = 0;
  read_numbers(object, name, H5T_NATIVE_INT64, 1, &value);
  return value;
}

std::vector<double> File::read_doubles_attribute(const std::string& object, const std::string& name,
                                                 std::size_t count) const {
  std::vector<double> values(count);
  read_numbers(object, name, H5T_NATIVE_DOUBLE, count, values.data());
  return values;
}

}  // namespace irdm::hdf5
