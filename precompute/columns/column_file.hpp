#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <vector>

#include "common/model/model_writer.hpp"

namespace irdm::precompute {

/// Columns begin <= b < end of R.
struct ColumnRange {
  int begin = 0;
  int end = 0;

  int count() const { return end - begin; }
  bool operator==(const ColumnRange&) const = default;
};

/// "A:B" as the command line has it, 0 <= A < B. Throws std::invalid_argument with a message.
ColumnRange column_range_from_text(const std::string& text);

std::string to_text(const ColumnRange& range);

/// The part of `range` that one of `size` equal workers does: the parts follow one another without
/// gap, differ by one block at most and begin at whole blocks, so that nothing is computed twice.
/// @param rank 0..size-1
/// @param block columns that are computed together, see ColumnSource
ColumnRange share_of(const ColumnRange& range, int rank, int size, int block);

// A slice of R on its own: the work file of a run that goes on where it was interrupted, and, once
// complete, a part for `irdm-precompute merge`. Plain bytes, only ever appended to, because an
// HDF5 file that is killed while it is written may be lost as a whole:
//
//     irdm-columns 1
//     columns A B
//     shape 3n T BYTES           of one number: 4 or 8
//     centrifugal 6              only where such columns follow those of R
//     gravity 3                  the same of gravity
//     settings LENGTH
//     description LENGTH
//     (settings) (description: mesh, body and material as an HDF5 file) (CRC32C of all so far)
//     then for each column A..B-1, and for each centrifugal one and each of gravity: T x 3n
//     numbers [s][a] (CRC32C)
//
// A record whose checksum is wrong, and all after it, do not count.

inline constexpr int kGravityColumns = 3;  ///< one an axis of B

struct ColumnFileHeader {
  ColumnRange range;
  int degrees_of_freedom = 0;  ///< 3n
  int steps = 0;               ///< T
  Precision precision = Precision::kSingle;
  bool centrifugal = false;  ///< six columns more, for the SpinProducts
  bool gravity = false;      ///< three columns more, for the axes
  std::string settings;      ///< all else that R depends on, see settings_text()
  std::string description;   ///< see description_of()

  std::size_t column_bytes() const;
  /// Columns of a complete file: those of R, the centrifugal ones and those of gravity.
  int stored_columns() const;
};

/// Mesh, body, material, dt and steps of a model as bytes, the same for the same model.
std::string description_of(const Model& model);

/// The beginning of the file, up to the first column.
std::string encode_header(const ColumnFileHeader& header);

inline constexpr std::size_t kChecksumBytes = 4;
std::uint32_t column_checksum(const void* bytes, std::size_t count);
/// Whether the last four of these bytes are the checksum of those before.
bool is_intact(std::span<const std::uint8_t> record);

/// Reads a column file. Throws Error when it is of another kind, damaged or not complete.
class ColumnFileReader {
 public:
  explicit ColumnFileReader(const std::filesystem::path& path);

  const std::string& name() const { return name_; }
  const ColumnFileHeader& header() const { return header_; }
  /// Bytes of the next column, checked; valid until the next call.
  std::span<const std::uint8_t> next();
  /// Back to the first column.
  void rewind();

 private:
  [[noreturn]] void damaged(const std::string& what) const;

  std::string name_;
  std::ifstream stream_;
  ColumnFileHeader header_;
  std::streamoff columns_at_ = 0;
  std::vector<std::uint8_t> column_;
};

/// Writes a column file, or goes on with one of the same header. Locked: a second process that
/// wants the same file is refused. It stays where it is when the program ends early. Throws Error.
class ColumnFileWriter {
 public:
  ColumnFileWriter(std::filesystem::path path, const ColumnFileHeader& header);
  ColumnFileWriter(const ColumnFileWriter&) = delete;
  ColumnFileWriter& operator=(const ColumnFileWriter&) = delete;
  ~ColumnFileWriter();

  /// Columns that the file has from an earlier run.
  int resumed() const { return resumed_; }
  /// There was a file, of other content, that has been given up.
  bool replaced() const { return replaced_; }

  /// The next column.
  void append(std::span<const std::uint8_t> column);
  /// Waits until all columns so far are on the disk.
  void sync();
  /// Gives the complete file its final name.
  void commit(const std::filesystem::path& name);

 private:
  void write(const void* bytes, std::size_t count);
  void open_locked();
  bool starts_with(const std::string& head) const;
  int count_whole_columns(std::size_t head, const ColumnFileHeader& header) const;

  std::filesystem::path path_;
  int file_ = -1;
  int resumed_ = 0;
  bool replaced_ = false;
};

}  // namespace irdm::precompute
