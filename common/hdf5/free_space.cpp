#include "common/hdf5/free_space.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>

namespace irdm::hdf5 {
namespace {

// What the index of the chunks grows by for one more, and HDF5's small blocks: nodes of 2.6 kB that
// are split, in the older format; in that of 1.10 a block of the extensible array, which has 32 kB
// where there are a million chunks.
constexpr hsize_t kIndexBytes = 64 << 10;

int descriptor(hid_t file) noexcept {
  void* handle = nullptr;
  if (H5Fget_vfd_handle(file, H5P_DEFAULT, &handle) < 0 || handle == nullptr) return -1;
  return *static_cast<const int*>(handle);
}

haddr_t end_of(hid_t file) noexcept {
  haddr_t end = 0;
  H5Fget_eoa(file, &end);
  return end;
}

int allocate(int file, off_t begin, off_t end) noexcept {
  while (::fallocate(file, 0, begin, end - begin) != 0) {
    if (errno != EINTR) return errno;
  }
  return 0;
}

int lengthen(int file, off_t end) noexcept {
  struct stat now {};
  if (::fstat(file, &now) != 0) return errno;
  return now.st_size >= end || ::ftruncate(file, end) == 0 ? 0 : errno;
}

}  // namespace

hsize_t growth(const Handle& dataset, hsize_t rows, hsize_t more) {
  const Handle creation(H5Dget_create_plist(dataset.get()), H5Pclose);
  std::array<hsize_t, H5S_MAX_RANK> chunk{};
  const int rank = H5Pget_chunk(creation.get(), H5S_MAX_RANK, chunk.data());
  const Handle type(H5Dget_type(dataset.get()), H5Tclose);
  hsize_t bytes = H5Tget_size(type.get());
  for (int i = 0; i < rank; ++i) bytes *= chunk[static_cast<std::size_t>(i)];
  const auto chunks = [&](hsize_t n) { return (n + chunk[0] - 1) / chunk[0]; };
  return (chunks(rows + more) - chunks(rows)) * (bytes + kIndexBytes);
}

int ReservedSpace::reserve(hid_t file, hsize_t bytes) noexcept {
  const int disk = descriptor(file);
  if (disk < 0) return 0;
  const haddr_t end = end_of(file);
  const auto begin = static_cast<off_t>(std::min(sure_, end));
  const auto wanted = static_cast<off_t>(end + bytes);
  int error = allocate(disk, begin, wanted);
  if (error == EOPNOTSUPP) error = lengthen(disk, wanted);
  if (error == 0) sure_ = end;
  return error;
}

void ReservedSpace::release(hid_t file) noexcept {
  const int disk = descriptor(file);
  const haddr_t end = end_of(file);
  // A file that stays too long is as good.
  if (disk < 0 || end == 0) return;
  [[maybe_unused]] const int ignored = ::ftruncate(disk, static_cast<off_t>(end));
}

std::string WatchedPlace::fault(hid_t file, const std::filesystem::path& path) const {
  const int disk = descriptor(file);
  struct stat opened {};
  struct stat named {};
  if (disk < 0 || ::fstat(disk, &opened) != 0) return "";
  // HDF5 itself shortens a file whose last blocks have become free.
  if (static_cast<std::uintmax_t>(opened.st_size) <
      std::min<std::uintmax_t>(length_, end_of(file))) {
    return "was cut off while it was written";
  }
  if (::stat(path.c_str(), &named) != 0) {
    return errno == ENOENT || errno == ENOTDIR ? "was removed while it was written" : "";
  }
  const bool same = opened.st_dev == named.st_dev && opened.st_ino == named.st_ino;
  return same ? "" : "was replaced by another file while it was written";
}

void WatchedPlace::keep_length(hid_t file) noexcept {
  struct stat now {};
  const int disk = descriptor(file);
  // The end that HDF5 counts with: what is reserved behind it comes and goes.
  if (disk >= 0 && ::fstat(disk, &now) == 0) {
    length_ = std::min<std::uintmax_t>(static_cast<std::uintmax_t>(now.st_size), end_of(file));
  }
}

}  // namespace irdm::hdf5
