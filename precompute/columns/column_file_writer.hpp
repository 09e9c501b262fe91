#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "precompute/columns/column_file.hpp"

namespace irdm::precompute {

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
