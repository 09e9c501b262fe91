#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/hdf5/file.hpp"

/// The checksum that a model file carries of its own content: root attribute `content_sha256`.
namespace irdm {

/// SHA-256, lower-case hexadecimal, of mesh, body, material, dt, steps, kind, modes, centrifugal
/// responses, responses to gravity, what modes that are left out add, and compressed responses; of
/// those that the file has, in this order: for every dataset its path, a zero byte, its extents as
/// u64 and its numbers as they are stored; for every attribute its object, '@', its name, a zero
/// byte and its value (text, or f64). Little-endian. Dense R has its share by the checksums of its
/// columns, last of all. Reads all datasets but R, a few megabytes at a time. Throws Error when
/// something cannot be read.
std::string content_checksum(const hdf5::File& file);

/// What the file says that it should be; nothing in files made before there was one.
std::optional<std::string> stored_content_checksum(const hdf5::File& file);

/// Computes the checksum of an open new file and stores it there.
void store_content_checksum(hdf5::File& file);

/// Throws Error where the file says that its content should be another one. A file without a
/// checksum was made before there was one, and passes.
void require_content_checksum(const hdf5::File& file);

/// 64-bit checksum of numbers as they are stored: FNV-1a by words of 8 bytes, the last one filled
/// up with zeros. Runs at the speed of memory; a change of a single word always shows.
template <typename Scalar>
std::uint64_t number_checksum(const Scalar* numbers, std::size_t count);

/// Checksums of the columns of dense R, dataset `column_checksum` (u64, 3n) beside it: a column is
/// compared when it is read, so that R of many gigabytes is never read for its checksum alone.
class ColumnChecksums {
 public:
  /// Reads those of a file; none where it was made before there were any. Throws Error.
  /// @param columns of R
  ColumnChecksums(const hdf5::File& file, std::size_t columns);

  bool empty() const { return checksums_.empty(); }
  /// Throws Error where column b, [s][a], is not what was written.
  template <typename Scalar>
  void compare(std::size_t b, const Scalar* column, std::size_t count) const;

 private:
  std::string name_;  ///< of the file
  std::vector<std::uint64_t> checksums_;
};

}  // namespace irdm
