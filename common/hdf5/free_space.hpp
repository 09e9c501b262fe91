#pragma once

#include <hdf5.h>
#include <filesystem>
#include <string>

#include "common/hdf5/handle.hpp"

namespace irdm::hdf5 {

/// Bytes that the file grows by at most when a chunked dataset, whose space is allocated early,
/// gets `more` rows beyond its `rows`: whole chunks and their index. 0 when its last chunk has
/// room.
hsize_t growth(const Handle& dataset, hsize_t rows, hsize_t more);

/// Space on the disk behind the end of an open file. HDF5 changes its index in place and can lose
/// all that a file holds when it finds the disk full in the middle of that; with the room there
/// before, it never does. The file is longer meanwhile, never shorter than its superblock says.
class ReservedSpace {
 public:
  /// Makes sure that the file can grow by so many bytes. Returns 0, or the errno of why it cannot;
  /// then what it holds is untouched. Where no room can be kept free, only the length grows.
  int reserve(hid_t file, hsize_t bytes) noexcept;
  /// Cuts off what HDF5 has not used. After a flush.
  void release(hid_t file) noexcept;

 private:
  haddr_t sure_ = 0;  ///< below it all is on the disk
};

/// Tells whether an open file that is being written is still the one that its path names.
class WatchedPlace {
 public:
  /// Why it is not: "was removed while it was written", say; empty while it is.
  std::string fault(hid_t file, const std::filesystem::path& path) const;
  /// Keeps the length of the file as it is now. After a flush.
  void keep_length(hid_t file) noexcept;

 private:
  std::uintmax_t length_ = 0;  ///< [byte]
};

}  // namespace irdm::hdf5
