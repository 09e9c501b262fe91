#include "tests/fuzz/edited_file.hpp"

#include <hdf5.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <limits>
#include <utility>

#include "common/hdf5/file.hpp"
#include "common/hdf5/handle.hpp"
#include "tests/fuzz/scratch_file.hpp"

namespace irdm::fuzz {
namespace {

using hdf5::Handle;

/// Takes one thing after another from the input; zeros once it is used up.
class Choices {
 public:
  explicit Choices(Input input) : rest_(input) {}
  bool any() const { return !rest_.empty(); }
  std::uint8_t byte() {
    const std::uint8_t value = any() ? rest_[0] : 0;
    rest_ = rest_.subspan(any() ? 1 : 0);
    return value;
  }
  template <std::size_t N>
  auto one_of(const std::array<double, N>& values) {
    return values[byte() % N];
  }
  std::string text() {
    const std::size_t size = std::min<std::size_t>(byte() % 16, rest_.size());
    std::string value(text_of(rest_.first(size)));
    rest_ = rest_.subspan(size);
    return value;
  }
  double number() {
    using Limits = std::numeric_limits<double>;
    constexpr auto kNumbers = std::to_array<double>(
        {0.0, 1.0, -1.0, 2.0, 0.5, 1e-9, 3.0, 1e300, -3.0, Limits::quiet_NaN(), Limits::infinity(),
         0x1p31, 1e6, 255.0, 4.0, 8.0, -0x1p31, 1e-300});
    return one_of(kNumbers);
  }

 private:
  Input rest_;
};

Handle space_of(Choices& choices) {
  constexpr std::array kExtents = {0.0, 1.0,  2.0,  3.0,    4.0,    6.0,
                                   9.0, 10.0, 24.0, 0x1p31, 0x1p40, 0x1p62};
  std::array<hsize_t, 4> extents{};
  const int rank = choices.byte() % 5;
  for (int i = 0; i < rank; ++i) {
    extents[static_cast<std::size_t>(i)] = static_cast<hsize_t>(choices.one_of(kExtents));
  }
  if (rank == 0) return {H5Screate(H5S_SCALAR), H5Sclose};
  return {H5Screate_simple(rank, extents.data(), nullptr), H5Sclose};
}

Handle type_of(Choices& choices) {
  const std::array types = {H5T_NATIVE_DOUBLE, H5T_NATIVE_FLOAT, H5T_NATIVE_INT32,
                            H5T_NATIVE_UINT8,  H5T_NATIVE_INT64, H5T_C_S1};
  const int choice = choices.byte() % 7;
  Handle type(H5Tcopy(types[static_cast<std::size_t>(choice % 6)]), H5Tclose);
  if (choice == 6) {
    type = Handle(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(type.get(), H5T_VARIABLE);
  }
  return type;
}

/// In chunks, so that a large one takes no place.
void make_dataset(hid_t file, const std::string& name, hid_t type, hid_t space) {
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  const int rank = H5Sget_simple_extent_ndims(space);
  constexpr std::array<hsize_t, 4> kChunk = {1, 1, 1, 1};
  if (rank > 0) H5Pset_chunk(creation.get(), rank, kChunk.data());
  const Handle made(
      H5Dcreate2(file, name.c_str(), type, space, H5P_DEFAULT, creation.get(), H5P_DEFAULT),
      H5Dclose);
}

void edit_dataset(hid_t file, const std::string& name, Choices& choices) {
  constexpr hssize_t kMostElements = 1 << 16;
  enum { kRemove, kNumber, kReshape, kRetype, kGroup, kExternal, kVirtual };
  const int what = choices.byte() % 7;
  Handle set(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
  const Handle space(H5Dget_space(set.get()), H5Sclose);
  const Handle type(H5Dget_type(set.get()), H5Tclose);
  const hssize_t size = H5Sget_simple_extent_npoints(space.get());
  if (set.get() < 0 || size < 0 || size > kMostElements) return;
  std::vector<double> values(static_cast<std::size_t>(size));
  const bool numbers =
      H5Dread(set.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0;
  if (what == kNumber) {
    if (!numbers || values.empty()) return;
    values[static_cast<std::size_t>(choices.byte() + 256 * choices.byte()) % values.size()] =
        choices.number();
    H5Dwrite(set.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    return;
  }
  set = Handle();
  H5Ldelete(file, name.c_str(), H5P_DEFAULT);
  if (what == kReshape) make_dataset(file, name, type.get(), space_of(choices).get());
  if (what == kRetype) {
    make_dataset(file, name, type_of(choices).get(), space.get());
    const Handle again(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
    if (numbers)
      H5Dwrite(again.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  }
  if (what == kExternal || what == kVirtual) {
    const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    if (what == kExternal) {
      H5Pset_external(creation.get(), "gone.raw", 0, H5F_UNLIMITED);
    } else {
      H5Pset_virtual(creation.get(), space.get(), "gone.h5", "/gone", space.get());
    }
    Handle(H5Dcreate2(file, name.c_str(), type.get(), space.get(), H5P_DEFAULT, creation.get(),
                      H5P_DEFAULT),
           H5Dclose);
  }
  if (what == kGroup)
    Handle(H5Gcreate2(file, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
}

/// A list of texts, of fixed or of variable length.
void make_texts(hid_t owner, const std::string& name, Choices& choices) {
  const std::string text = choices.text();
  const bool variable = choices.byte() % 2 == 0;
  const hsize_t count = 1 + 17 * (choices.byte() % 200);
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.get(), variable ? H5T_VARIABLE : text.size() + 1);
  const Handle space(H5Screate_simple(1, &count, nullptr), H5Sclose);
  const Handle attribute(
      H5Acreate2(owner, name.c_str(), type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  const std::vector<const char*> pointers(count, text.c_str());
  std::string all;
  for (hsize_t i = 0; i < count; ++i) all.append(text.c_str(), text.size() + 1);
  const void* values = all.data();
  if (variable) values = pointers.data();
  H5Awrite(attribute.get(), type.get(), values);
}

void edit_attribute(hid_t file, const std::string& object, const std::string& name,
                    Choices& choices) {
  enum { kRemove, kNumber, kText, kShape, kVariableText, kTexts };
  const int what = choices.byte() % 6;
  const Handle owner(H5Oopen(file, object.c_str(), H5P_DEFAULT), H5Oclose);
  H5Adelete(owner.get(), name.c_str());
  if (what == kRemove) return;
  if (what == kTexts) return make_texts(owner.get(), name, choices);
  const Handle scalar(H5Screate(H5S_SCALAR), H5Sclose);
  Handle type(H5Tcopy(what == kNumber || what == kShape ? H5T_NATIVE_DOUBLE : H5T_C_S1), H5Tclose);
  const std::string text = what == kText || what == kVariableText ? choices.text() : std::string();
  if (what == kText) H5Tset_size(type.get(), text.size() + 1);
  if (what == kVariableText) H5Tset_size(type.get(), H5T_VARIABLE);
  constexpr hsize_t kCount = 9;
  const hsize_t count = choices.byte() % 2 == 0 ? kCount : 3;
  const Handle list(H5Screate_simple(1, &count, nullptr), H5Sclose);
  const Handle attribute(
      H5Acreate2(owner.get(), name.c_str(), type.get(), what == kShape ? list.get() : scalar.get(),
                 H5P_DEFAULT, H5P_DEFAULT),
      H5Aclose);
  std::array<double, kCount> numbers{};
  numbers.fill(what == kNumber || what == kShape ? choices.number() : 0.0);
  const char* words = text.c_str();
  const void* value = what == kText           ? words
                      : what == kVariableText ? static_cast<const void*>(&words)
                                              : numbers.data();
  H5Awrite(attribute.get(), type.get(), value);
}

std::string content(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

EditedFile::EditedFile(const std::filesystem::path& valid) : image_(content(valid)) {
  const hdf5::File file = hdf5::File::open(valid);
  const auto add_name = [](hid_t, const char* name, const H5O_info_t* info, void* list) -> herr_t {
    const bool set = info->type == H5O_TYPE_DATASET;
    static_cast<std::vector<std::pair<std::string, bool>>*>(list)->emplace_back(std::string(name),
                                                                                set);
    return 0;
  };
  std::vector<std::pair<std::string, bool>> objects;
#if H5_VERSION_GE(1, 12, 0)
  H5Ovisit3(file.id(), H5_INDEX_NAME, H5_ITER_INC, add_name, &objects, H5O_INFO_BASIC);
#else
  H5Ovisit1(file.id(), H5_INDEX_NAME, H5_ITER_INC, add_name, &objects);
#endif
  for (const auto& [name, is_set] : objects) {
    if (is_set) datasets_.push_back(name);
    const Handle owner(H5Oopen(file.id(), name.c_str(), H5P_DEFAULT), H5Oclose);
    const auto add_attribute = [](hid_t, const char* each, const H5A_info_t*,
                                  void* list) -> herr_t {
      static_cast<std::vector<std::string>*>(list)->emplace_back(each);
      return 0;
    };
    std::vector<std::string> names;
    H5Aiterate2(owner.get(), H5_INDEX_NAME, H5_ITER_INC, nullptr, add_attribute, &names);
    for (const std::string& each : names) attributes_.emplace_back(name, each);
  }
}

std::filesystem::path EditedFile::edited(Input input) const {
  std::filesystem::path path = scratch_file("it.h5", image_);
  Choices choices(input);
  const Handle file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
  const std::size_t count = datasets_.size() + attributes_.size();
  constexpr int kMostEdits = 16;
  for (int i = 0; i < kMostEdits && choices.any(); ++i) {
    const std::size_t which = choices.byte() % count;
    if (which < datasets_.size()) {
      edit_dataset(file.get(), datasets_[which], choices);
    } else {
      const auto& [owner, name] = attributes_[which - datasets_.size()];
      edit_attribute(file.get(), owner, name, choices);
    }
  }
  return path;
}

}  // namespace irdm::fuzz
