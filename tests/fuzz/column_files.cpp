// Slices of R on their own, with mended or given checksums.
#include <algorithm>
#include <cstring>

#include "common/error.hpp"
#include "precompute/columns/column_file.hpp"
#include "tests/fuzz/harness.hpp"
#include "tests/fuzz/scratch_file.hpp"

namespace irdm::fuzz {
namespace {

using namespace irdm::precompute;

void append_sealed(Input record, std::string& file) {
  const std::uint32_t sum = column_checksum(record.data(), record.size());
  file.append(text_of(record));
  file.append(reinterpret_cast<const char*>(&sum), kChecksumBytes);
}

/// Header and columns, each with its checksum.
std::string sealed_file(Input records, std::size_t header, std::size_t column) {
  std::string file;
  append_sealed(records.first(std::min(header, records.size())), file);
  records = records.subspan(std::min(header, records.size()));
  while (!records.empty()) {
    const std::size_t size = std::min(column, records.size());
    append_sealed(records.first(size), file);
    records = records.subspan(size);
  }
  return file;
}

}  // namespace

void column_file(Input input) {
  constexpr std::size_t kHead = 3;
  if (input.size() < kHead) return;
  const std::size_t header = input[0] + 256u * input[1];
  const std::size_t column = input[2];
  const Input rest = input.subspan(kHead);
  const std::string content =
      column == 0 ? std::string(text_of(rest)) : sealed_file(rest, header, column);
  try {
    ColumnFileReader reader(scratch_file("it.irdm-columns", content));
    const ColumnFileHeader& found = reader.header();
    expect(found.range.count() > 0 && found.range.end <= found.degrees_of_freedom,
           "a slice has columns of R");
    std::string again = encode_header(found);
    for (int i = 0; i < found.stored_columns(); ++i) append_sealed(reader.next(), again);
    ColumnFileReader second(scratch_file("again.irdm-columns", again));
    reader.rewind();
    for (int i = 0; i < found.stored_columns(); ++i) {
      expect(std::ranges::equal(reader.next(), second.next()), "columns are written and read");
    }
  } catch (const Error&) {
  }
}

}  // namespace irdm::fuzz
