#include <algorithm>
#include <limits>

#include "precompute/columns/column_file.hpp"
#include "tests/fuzz/seed_folder.hpp"

namespace irdm::fuzz {
namespace {

/// Length of the header and of a column, then both without checksums.
SeedBytes column_file(const precompute::ColumnFileHeader& header, std::size_t columns) {
  const std::string text = encode_header(header);
  const std::size_t size = text.size() - precompute::kChecksumBytes;
  const std::size_t column = header.column_bytes();
  SeedBytes bytes(3 + size + columns * column, 0x3A);
  bytes[0] = static_cast<std::uint8_t>(size % 256);
  bytes[1] = static_cast<std::uint8_t>(size / 256);
  bytes[2] = static_cast<std::uint8_t>(column);
  std::copy_n(text.begin(), size, bytes.begin() + 3);
  return bytes;
}

void write_column_files(const Seeds& seeds) {
  const auto write = [&](const std::string& name, const SeedBytes& bytes) {
    seeds.write("column_file", name, bytes);
  };
  precompute::ColumnFileHeader header{.range = {3, 6},
                                      .degrees_of_freedom = 6,
                                      .steps = 2,
                                      .settings = "E = 2000\n",
                                      .description = "some bytes"};
  const SeedBytes whole = column_file(header, 3);
  write("whole", whole);
  write("cut_off", SeedBytes(whole.begin(), whole.end() - 60));
  SeedBytes as_it_is = whole;
  as_it_is[2] = 0;
  write("damaged", as_it_is);
  write("no_columns", column_file(header, 0));
  SeedBytes other_column = whole;
  other_column[2] += 4;
  other_column.resize(other_column.size() + 100);
  write("damaged_column", other_column);
  header.precision = Precision::kDouble;
  header.centrifugal = header.gravity = true;
  write("all_options", column_file(header, 12));
  header.degrees_of_freedom = header.steps = std::numeric_limits<int>::max();
  header.settings.clear();
  write("impossible", column_file(header, 0));
}

}  // namespace

void write_file_seeds(const Seeds& seeds) {
  write_column_files(seeds);
  for (const char* edited : {"packed_model_file", "run_file"}) {
    seeds.write(edited, "untouched", std::string());
  }
}

}  // namespace irdm::fuzz
