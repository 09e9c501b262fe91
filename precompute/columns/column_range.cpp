#include "precompute/columns/column_range.hpp"

#include <algorithm>
#include <charconv>
#include <stdexcept>

#include "common/quoted.hpp"

namespace irdm::precompute {
namespace {

bool read_number(const char*& at, const char* end, int& value) {
  const auto [next, error] = std::from_chars(at, end, value);
  at = next;
  return error == std::errc() && value >= 0;
}

}  // namespace

ColumnRange column_range_from_text(const std::string& text) {
  ColumnRange range;
  const char* at = text.data();
  const char* const end = at + text.size();
  const bool good = read_number(at, end, range.begin) && at != end && *at++ == ':' &&
                    read_number(at, end, range.end) && at == end && range.begin < range.end;
  if (!good) throw std::invalid_argument(in_quotes(text) + " is not A:B with 0 <= A < B");
  return range;
}

std::string to_text(const ColumnRange& range) {
  return std::to_string(range.begin) + ":" + std::to_string(range.end);
}

ColumnRange share_of(const ColumnRange& range, int rank, int size, int block) {
  const int first = range.begin / block;
  const int blocks = (range.end + block - 1) / block - first;
  const auto cut = [&](int k) {
    const auto whole = static_cast<long>(blocks) * k / size;
    return std::clamp(static_cast<int>(first + whole) * block, range.begin, range.end);
  };
  return {cut(rank), rank + 1 == size ? range.end : cut(rank + 1)};
}

}  // namespace irdm::precompute
