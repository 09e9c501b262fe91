#include "precompute/mesh/format/number_array.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <map>

namespace irdm::precompute {
namespace {

template <typename Number>
double decode(std::string_view bytes, std::endian order) {
  std::array<char, sizeof(Number)> raw;
  std::copy_n(bytes.begin(), raw.size(), raw.begin());
  if (order != std::endian::native) std::reverse(raw.begin(), raw.end());
  Number value;
  std::memcpy(&value, raw.data(), sizeof value);
  return static_cast<double>(value);
}

}  // namespace

std::optional<NumberType> number_type(std::string_view name) {
  using enum NumberType;
  static const std::map<std::string_view, NumberType> types{
      {"char", kInt8},       {"unsigned_char", kUInt8},
      {"short", kInt16},     {"unsigned_short", kUInt16},
      {"int", kInt32},       {"unsigned_int", kUInt32},
      {"long", kInt64},      {"unsigned_long", kUInt64},
      {"float", kFloat32},   {"double", kFloat64},
      {"vtkIdType", kInt32}, {"vtktypeint64", kInt64},
      {"uchar", kUInt8},     {"ushort", kUInt16},
      {"uint", kUInt32},     {"int8", kInt8},
      {"uint8", kUInt8},     {"int16", kInt16},
      {"uint16", kUInt16},   {"int32", kInt32},
      {"uint32", kUInt32},   {"float32", kFloat32},
      {"float64", kFloat64}, {"Int8", kInt8},
      {"UInt8", kUInt8},     {"Int16", kInt16},
      {"UInt16", kUInt16},   {"Int32", kInt32},
      {"UInt32", kUInt32},   {"Int64", kInt64},
      {"UInt64", kUInt64},   {"Float32", kFloat32},
      {"Float64", kFloat64}};
  const auto found = types.find(name);
  return found == types.end() ? std::nullopt : std::optional(found->second);
}

std::size_t size_of(NumberType type) {
  constexpr std::array<std::size_t, 10> sizes{1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  return sizes[static_cast<std::size_t>(type)];
}

double decode_number(std::string_view bytes, NumberType type, std::endian order) {
  switch (type) {
    case NumberType::kInt8:
      return decode<std::int8_t>(bytes, order);
    case NumberType::kUInt8:
      return decode<std::uint8_t>(bytes, order);
    case NumberType::kInt16:
      return decode<std::int16_t>(bytes, order);
    case NumberType::kUInt16:
      return decode<std::uint16_t>(bytes, order);
    case NumberType::kInt32:
      return decode<std::int32_t>(bytes, order);
    case NumberType::kUInt32:
      return decode<std::uint32_t>(bytes, order);
    case NumberType::kInt64:
      return decode<std::int64_t>(bytes, order);
    case NumberType::kUInt64:
      return decode<std::uint64_t>(bytes, order);
    case NumberType::kFloat32:
      return static_cast<double>(decode<float>(bytes, order));
    case NumberType::kFloat64:
      return decode<double>(bytes, order);
  }
  return 0.0;
}

std::vector<double> decode_numbers(std::string_view bytes, NumberType type, std::endian order) {
  const std::size_t size = size_of(type);
  std::vector<double> numbers(bytes.size() / size);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    numbers[i] = decode_number(bytes.substr(i * size), type, order);
  }
  return numbers;
}

}  // namespace irdm::precompute
