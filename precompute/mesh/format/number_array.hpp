#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace irdm::precompute {

/// How a number is stored in a binary file.
enum class NumberType {
  kInt8,
  kUInt8,
  kInt16,
  kUInt16,
  kInt32,
  kUInt32,
  kInt64,
  kUInt64,
  kFloat32,
  kFloat64
};

/// The type with this name in VTK's legacy and XML files or in PLY: "int", "vtktypeint64",
/// "Float32", "uchar", ... None: unknown.
std::optional<NumberType> number_type(std::string_view name);

/// [byte]
std::size_t size_of(NumberType type);

/// One number at the beginning of `bytes`, which must be long enough. Whole numbers are exact up to
/// 2^53, far above any index in a file that can be read.
double decode_number(std::string_view bytes, NumberType type, std::endian order);

/// All numbers in `bytes`.
std::vector<double> decode_numbers(std::string_view bytes, NumberType type, std::endian order);

}  // namespace irdm::precompute
