#include "common/hdf5/file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <fstream>
#include <limits>
#include <system_error>

#include "common/config/input_file.hpp"
#include "common/error.hpp"

namespace irdm::hdf5 {

Handle dataset_properties(const Layout& layout) {
  Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(properties.get(), 0);
  if (layout.chunk.empty()) return properties;
  H5Pset_chunk(properties.get(), static_cast<int>(layout.chunk.size()), layout.chunk.data());
  if (layout.fletcher32) H5Pset_fletcher32(properties.get());
  return properties;
}

template <>
hid_t native_type<double>() {
  return H5T_NATIVE_DOUBLE;
}
template <>
hid_t native_type<float>() {
  return H5T_NATIVE_FLOAT;
}
template <>
hid_t native_type<std::int16_t>() {
  return H5T_NATIVE_INT16;
}
template <>
hid_t native_type<std::int32_t>() {
  return H5T_NATIVE_INT32;
}
template <>
hid_t native_type<std::uint8_t>() {
  return H5T_NATIVE_UINT8;
}
template <>
hid_t native_type<std::uint64_t>() {
  return H5T_NATIVE_UINT64;
}

namespace {

Handle make_space(const Shape& shape, const hsize_t* maximum = nullptr) {
  if (shape.empty()) return {H5Screate(H5S_SCALAR), H5Sclose};
  return {H5Screate_simple(static_cast<int>(shape.size()), shape.data(), maximum), H5Sclose};
}

// Missing groups on the way to a new object are made with it.
Handle make_link_properties() {
  Handle properties(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_create_intermediate_group(properties.get(), 1);
  return properties;
}

// The first that every file asks HDF5 for: its constants (H5F_ACC_RDONLY and others) start the
// library where they stand. Without locks: whoever looks whether a file is there
// would have one for a moment, and the making or the beginning of SWMR in that moment would fail.
// We write new files only, so that no two of us write to one.
Handle make_access_properties() {
  prepare_library();
  Handle properties(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_file_locking(properties.get(), 0, 1);
  return properties;
}

/// Whether one has the file open or has left it so: the superblock's consistency flags.
bool has_swmr_writer(const std::filesystem::path& path) {
  constexpr std::size_t kVersion = 8, kFlags = 11;
  constexpr int kWithFlags = 3, kSwmrWriter = 4;
  std::array<char, 12> superblock{};
  std::ifstream(path, std::ios::binary).read(superblock.data(), superblock.size());
  return superblock[kVersion] == kWithFlags && (superblock[kFlags] & kSwmrWriter) != 0;
}

// Of the file in memory.
constexpr std::size_t kImageGrowth = 1 << 16;

/// Numbers of that shape; the largest there is when they cannot be counted.
hsize_t product(const Shape& shape) {
  if (std::ranges::find(shape, hsize_t{0}) != shape.end()) return 0;
  hsize_t numbers = 1;
  for (const hsize_t extent : shape) {
    if (numbers > std::numeric_limits<hsize_t>::max() / extent) {
      return std::numeric_limits<hsize_t>::max();
    }
    numbers *= extent;
  }
  return numbers;
}

std::string to_text(const Shape& shape, const char* zero = "0") {
  std::string text = "(";
  for (std::size_t i = 0; i < shape.size(); ++i) {
    text += (i > 0 ? ", " : "") + (shape[i] == 0 ? std::string(zero) : std::to_string(shape[i]));
  }
  return text + ")";
}

/// ": No space left on device", say, where the operating system refused something that a call of
/// HDF5 needed.
std::string cause_of(int error) {
  constexpr std::array kCauses = {ENOSPC, EDQUOT, EFBIG,  EIO,    EROFS,
                                  EMFILE, ENFILE, ENOMEM, EACCES, ESTALE};
  if (std::ranges::find(kCauses, error) == kCauses.end()) return "";
  return ": " + std::generic_category().message(error);
}

/// Whether this program has the file open, by whatever handle of HDF5.
bool is_open_here(const std::filesystem::path& path) {
  const ssize_t count = H5Fget_obj_count(H5F_OBJ_ALL, H5F_OBJ_FILE);
  std::vector<hid_t> files(static_cast<std::size_t>(std::max<ssize_t>(0, count)));
  if (files.empty()) return false;
  H5Fget_obj_ids(H5F_OBJ_ALL, H5F_OBJ_FILE, files.size(), files.data());
  return std::ranges::any_of(files, [&](hid_t file) {
    std::string name(4096, '\0');
    const ssize_t length = H5Fget_name(file, name.data(), name.size());
    name.resize(static_cast<std::size_t>(std::clamp<ssize_t>(length, 0, 4095)));
    std::error_code ignored;
    return std::filesystem::equivalent(name, path, ignored);
  });
}

[[noreturn]] void fail_open(const std::filesystem::path& path, int cause) {
  const std::string name = path.string();
  const int descriptor = ::open(name.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) cause = errno;
  if (descriptor >= 0) ::close(descriptor);
  const std::string because = cause_of(cause);
  if (!because.empty()) {
    throw Error(name, "cannot be opened" + because,
                "check its permissions and the limits of this process (ulimit -a)");
  }
  if (is_open_here(path)) {
    throw Error(name, "is open elsewhere in this program", "close it there");
  }
  throw Error(name, "is not a complete HDF5 file",
              "it is truncated, of another kind or not readable; make it again");
}

}  // namespace

// The library prints its own error stack to stderr by default; our errors are one line.
void prepare_library() {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

void leave_files_at_exit() {
  H5dont_atexit();
}

void File::fail_read(const std::string& what) const {
  throw Error(name_, what, "the file is damaged or of another kind; make it again");
}

void File::fail_write(const std::string& what) const {
  throw Error(name_, what + cause_of(errno), "check free space and permissions of the folder");
}

File File::create(const std::filesystem::path& path, const Handle& access) {
  constexpr const char* kRemedy = "check that the folder exists, is writable and has free space";
  const int descriptor = ::open(path.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
  if (descriptor < 0 && errno == EEXIST) {
    throw Error(path.string(), "exists already", "choose another name or remove it");
  }
  if (descriptor < 0) {
    throw Error(path.string(), "cannot be created: " + std::generic_category().message(errno),
                kRemedy);
  }
  ::close(descriptor);
  errno = 0;
  Handle file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.get()), H5Fclose);
  if (file.get() < 0) {
    const std::string because = cause_of(errno);
    ::unlink(path.c_str());
    throw Error(path.string(), "cannot be created" + because, kRemedy);
  }
  File made(std::move(file), path.string());
  made.reserved_.emplace();
  made.place_.emplace();
  return made;
}

File File::create(const std::filesystem::path& path) {
  return create(path, make_access_properties());
}

File File::create_for_swmr(const std::filesystem::path& path) {
  const Handle access = make_access_properties();
  H5Pset_libver_bounds(access.get(), H5F_LIBVER_V110, H5F_LIBVER_V110);
  return create(path, access);
}

void File::begin_swmr() {
  flush();
  if (H5Fstart_swmr_write(file_.get()) < 0) fail_write("cannot be opened for readers");
}

File File::open(const std::filesystem::path& path) {
  require_file(path);
  const Handle properties = make_access_properties();
  const unsigned access = H5F_ACC_RDONLY | (has_swmr_writer(path) ? H5F_ACC_SWMR_READ : 0u);
  errno = 0;
  Handle file(H5Fopen(path.c_str(), access, properties.get()), H5Fclose);
  const int cause = errno;
  // One that is open elsewhere in this program is opened with the same close degree and locking
  // only; h5py's degree is the strong one.
  for (const H5F_close_degree_t degree : {H5F_CLOSE_STRONG, H5F_CLOSE_DEFAULT}) {
    if (file.get() >= 0) break;
    const Handle others(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    H5Pset_fclose_degree(others.get(), degree);
    file = Handle(H5Fopen(path.c_str(), access, others.get()), H5Fclose);
  }
  if (file.get() < 0) fail_open(path, cause);
  return {std::move(file), path.string()};
}

File File::in_memory(const std::string& name) {
  const Handle access = make_access_properties();
  H5Pset_fapl_core(access.get(), kImageGrowth, 0);
  Handle file(H5Fcreate(name.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.get()), H5Fclose);
  if (file.get() < 0) throw Error(name, "cannot be made in memory", "free memory");
  return {std::move(file), name};
}

File File::from_image(const std::string& image, const std::string& name) {
  const Handle access = make_access_properties();
  H5Pset_fapl_core(access.get(), kImageGrowth, 0);
  std::string copy = image;  // HDF5 wants it writable and copies it
  H5Pset_file_image(access.get(), copy.data(), copy.size());
  Handle file(H5Fopen(name.c_str(), H5F_ACC_RDONLY, access.get()), H5Fclose);
  if (file.get() < 0) throw Error(name, "is damaged", "make it again");
  return {std::move(file), name};
}

std::string File::image() {
  flush();
  std::string bytes(
      static_cast<std::size_t>(std::max<ssize_t>(0, H5Fget_file_image(file_.get(), nullptr, 0))),
      '\0');
  if (H5Fget_file_image(file_.get(), bytes.data(), bytes.size()) <= 0) {
    fail_write("cannot be turned into bytes");
  }
  return bytes;
}

bool File::exists(const std::string& path) const {
  for (std::size_t end = path.find('/', 1);; end = path.find('/', end + 1)) {
    if (H5Lexists(file_.get(), path.substr(0, end).c_str(), H5P_DEFAULT) <= 0) return false;
    if (end == std::string::npos) return true;
  }
}

void File::create_group(const std::string& path) {
  const Handle links = make_link_properties();
  const Handle group(H5Gcreate2(file_.get(), path.c_str(), links.get(), H5P_DEFAULT, H5P_DEFAULT),
                     H5Gclose);
  if (group.get() < 0) fail_write("cannot create " + path);
}

void File::flush() {
  errno = 0;
  if (H5Fflush(file_.get(), H5F_SCOPE_GLOBAL) < 0) fail_write("cannot be written");
  if (place_) place_->keep_length(file_.get());
}

void File::require_in_place() const {
  if (!place_) return;
  const std::string fault = place_->fault(file_.get(), name_);
  if (!fault.empty()) throw Error(name_, fault, "leave it alone until it is complete");
}

void File::close() {
  flush();
  if (reserved_) reserved_->release(file_.get());
  file_ = Handle();
}

namespace {

// HDF5 follows links into other files by itself; a callback that fails is how to forbid it.
herr_t refuse_external_link(const char*, const char*, const char*, const char*, unsigned*, hid_t,
                            void*) {
  return -1;
}

Handle make_link_access(hid_t kind) {
  Handle properties(H5Pcreate(kind), H5Pclose);
  H5Pset_elink_cb(properties.get(), refuse_external_link, nullptr);
  return properties;
}

}  // namespace

void File::fail_foreign(const std::string& what) const {
  throw Error(name_, what, "only files that hold all of their data are read; write it as one file");
}

void File::check_links(const std::string& path) const {
  for (std::size_t end = path.find('/', 1);; end = path.find('/', end + 1)) {
    const std::string part = path.substr(0, end);
    H5L_info_t link{};
    if (H5Lget_info(file_.get(), part.c_str(), &link, H5P_DEFAULT) >= 0 &&
        link.type == H5L_TYPE_EXTERNAL) {
      fail_foreign(part + " is a link to another file");
    }
    if (end == std::string::npos) return;
  }
}

Handle File::open_object(const std::string& path) const {
  const Handle access = make_link_access(H5P_LINK_ACCESS);
  Handle object(H5Oopen(file_.get(), path.c_str(), access.get()), H5Oclose);
  if (object.get() < 0) check_links(path);
  if (object.get() < 0) fail_read("has no " + path);
  return object;
}

Handle File::open_dataset(const std::string& path) const {
  const Handle access = make_link_access(H5P_DATASET_ACCESS);
  Handle dataset(H5Dopen2(file_.get(), path.c_str(), access.get()), H5Dclose);
  if (dataset.get() < 0) check_links(path);
  if (dataset.get() < 0) fail_read("has no dataset " + path);
  const Handle creation(H5Dget_create_plist(dataset.get()), H5Pclose);
  if (H5Pget_external_count(creation.get()) > 0) {
    fail_foreign("dataset " + path + " lies in another file (external storage)");
  }
  if (H5Pget_layout(creation.get()) == H5D_VIRTUAL) {
    fail_foreign("dataset " + path + " is put together from other datasets (virtual)");
  }
  return dataset;
}

Handle File::make_dataset(const std::string& path, hid_t type, hid_t space,
                          const Handle& creation) {
  const Handle links = make_link_properties();
  Handle dataset(
      H5Dcreate2(file_.get(), path.c_str(), type, space, links.get(), creation.get(), H5P_DEFAULT),
      H5Dclose);
  if (dataset.get() < 0) fail_write("cannot create " + path);
  return dataset;
}

Shape File::shape(const std::string& dataset) const {
  if (!exists(dataset)) fail_read("has no dataset " + dataset);
  const Handle set = open_dataset(dataset);
  const Handle space(H5Dget_space(set.get()), H5Sclose);
  Shape extents(static_cast<std::size_t>(std::max(0, H5Sget_simple_extent_ndims(space.get()))));
  H5Sget_simple_extent_dims(space.get(), extents.data(), nullptr);
  return extents;
}

Shape File::stored_shape(const std::string& dataset) const {
  constexpr hsize_t kFew = 1'000'000;   // whatever the file holds
  constexpr hsize_t kMostAByte = 1000;  // numbers, however well they are compressed
  Shape found = shape(dataset);
  const hsize_t numbers = product(found);
  if (numbers > kFew && numbers / kMostAByte > H5Dget_storage_size(open_dataset(dataset).get())) {
    fail_read("dataset " + dataset + " has shape " + to_text(found) + ", but not the numbers");
  }
  return found;
}

std::size_t File::element_size(const std::string& dataset) const {
  const Handle set = open_dataset(dataset);
  const Handle type(H5Dget_type(set.get()), H5Tclose);
  return H5Tget_size(type.get());
}

template <typename T>
void File::create_dataset(const std::string& dataset, const Shape& shape, const Layout& layout) {
  make_dataset(dataset, native_type<T>(), make_space(shape).get(), dataset_properties(layout));
}

template <typename T>
void File::write(const std::string& dataset, const Shape& shape, const T* values) {
  errno = 0;
  const Handle set =
      make_dataset(dataset, native_type<T>(), make_space(shape).get(), dataset_properties({}));
  if (H5Dwrite(set.get(), native_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values) < 0) {
    fail_write("cannot write " + dataset);
  }
}

bool File::has_filter(const std::string& dataset, H5Z_filter_t filter) const {
  const Handle set = open_dataset(dataset);
  const Handle creation(H5Dget_create_plist(set.get()), H5Pclose);
  unsigned int flags = 0;
  std::size_t values = 0;
  return H5Pget_filter_by_id2(creation.get(), filter, &flags, &values, nullptr, 0, nullptr,
                              nullptr) >= 0;
}

bool File::stores_integers(const std::string& dataset) const {
  const Handle set = open_dataset(dataset);
  const Handle type(H5Dget_type(set.get()), H5Tclose);
  return H5Tget_class(type.get()) == H5T_INTEGER;
}

void File::check_kind(const std::string& dataset, hid_t wanted) const {
  const Handle set = open_dataset(dataset);
  const Handle type(H5Dget_type(set.get()), H5Tclose);
  const H5T_class_t kind = H5Tget_class(wanted);
  if (H5Tget_class(type.get()) == kind) return;
  fail_read("dataset " + dataset + " does not hold " +
            (kind == H5T_INTEGER ? "integers" : "floating-point numbers"));
}

template <typename T>
std::vector<T> File::read(const std::string& dataset, const Shape& expected) const {
  const Shape found = stored_shape(dataset);
  const bool fits =
      found.size() == expected.size() &&
      std::equal(found.begin(), found.end(), expected.begin(),
                 [](hsize_t have, hsize_t want) { return want == 0 || have == want; });
  if (!fits) {
    fail_read("dataset " + dataset + " has shape " + to_text(found) + ", expected " +
              to_text(expected, "any"));
  }
  check_kind(dataset, native_type<T>());
  std::vector<T> values(product(found));
  const Handle set = open_dataset(dataset);
  if (H5Dread(set.get(), native_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) {
    fail_read("dataset " + dataset + " cannot be read");
  }
  return values;
}

void File::transfer_slab(const std::string& dataset, const Shape& start, const Shape& count,
                         hid_t type, const void* source, void* target) const {
  const Handle set = open_dataset(dataset);
  const Handle space(H5Dget_space(set.get()), H5Sclose);
  const Handle memory = make_space(count);
  // HDF5 takes as many numbers of start and count as the set has axes.
  if (H5Sget_simple_extent_ndims(space.get()) != static_cast<int>(start.size()) ||
      H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, start.data(), nullptr, count.data(),
                          nullptr) < 0) {
    fail_read("dataset " + dataset + " has not " + std::to_string(start.size()) + " axes");
  }
  if (source != nullptr) {
    errno = 0;
    if (H5Dwrite(set.get(), type, memory.get(), space.get(), H5P_DEFAULT, source) < 0) {
      fail_write("cannot write into " + dataset);
    }
  } else if (H5Dread(set.get(), type, memory.get(), space.get(), H5P_DEFAULT, target) < 0) {
    fail_read("dataset " + dataset + " cannot be read, or its checksum is wrong");
  }
}

template <typename T>
void File::write_slab(const std::string& dataset, const Shape& start, const Shape& count,
                      const T* values) {
  transfer_slab(dataset, start, count, native_type<T>(), values, nullptr);
}

template <typename T>
void File::read_slab(const std::string& dataset, const Shape& start, const Shape& count,
                     T* values) const {
  check_kind(dataset, native_type<T>());
  transfer_slab(dataset, start, count, native_type<T>(), nullptr, values);
}

template <typename T>
void File::create_growing(const std::string& dataset, const Shape& row, hsize_t chunk_rows) {
  Shape shape{0};
  Shape maximum{H5S_UNLIMITED};
  Shape chunk{chunk_rows};
  for (const hsize_t extent : row) {
    shape.push_back(extent);
    maximum.push_back(extent);
    chunk.push_back(extent);
  }
  const Handle creation = dataset_properties({.chunk = chunk});
  // All that a dataset takes in the file it takes when it is extended.
  H5Pset_alloc_time(creation.get(), H5D_ALLOC_TIME_EARLY);
  make_dataset(dataset, native_type<T>(), make_space(shape, maximum.data()).get(), creation);
}

void File::reserve_for(const Handle& dataset, hsize_t rows, hsize_t more) {
  if (!reserved_) return;
  const hsize_t bytes = growth(dataset, rows, more);
  if (bytes == 0) return;
  const int error = reserved_->reserve(file_.get(), bytes);
  errno = error;
  if (error != 0) fail_write("cannot grow");
}

template <typename T>
void File::append(const std::string& dataset, hsize_t rows, const T* values) {
  Shape extents = shape(dataset);
  Shape start(extents.size(), 0);
  Shape count = extents;
  start[0] = extents[0];
  count[0] = rows;
  extents[0] += rows;
  {
    const Handle set = open_dataset(dataset);
    reserve_for(set, start[0], rows);
    if (H5Dset_extent(set.get(), extents.data()) < 0) fail_write("cannot extend " + dataset);
  }
  write_slab(dataset, start, count, values);
}

#define IRDM_HDF5_INSTANTIATE(T)                                                               \
  template void File::create_dataset<T>(const std::string&, const Shape&, const Layout&);      \
  template void File::write<T>(const std::string&, const Shape&, const T*);                    \
  template std::vector<T> File::read<T>(const std::string&, const Shape&) const;               \
  template void File::write_slab<T>(const std::string&, const Shape&, const Shape&, const T*); \
  template void File::read_slab<T>(const std::string&, const Shape&, const Shape&, T*) const;  \
  template void File::create_growing<T>(const std::string&, const Shape&, hsize_t);            \
  template void File::append<T>(const std::string&, hsize_t, const T*);
IRDM_HDF5_INSTANTIATE(double)
IRDM_HDF5_INSTANTIATE(float)
IRDM_HDF5_INSTANTIATE(std::int16_t)
IRDM_HDF5_INSTANTIATE(std::int32_t)
IRDM_HDF5_INSTANTIATE(std::uint8_t)
IRDM_HDF5_INSTANTIATE(std::uint64_t)
#undef IRDM_HDF5_INSTANTIATE

}  // namespace irdm::hdf5
