#pragma once

#include <bit>
#include <cstdint>

namespace irdm {

/// A number of IEEE 754 half precision: 11 significant bits, 6.1e-5 to 65504 with all of them and
/// in steps of 6e-8 below.
struct Half {
  std::uint16_t bits = 0;
};

/// The number itself, exactly; also where small single-precision numbers count as zero (see
/// NoDenormals). The number is finite.
inline float to_float(Half half) noexcept {
  constexpr std::uint32_t kExponent = 112U << 23;  // from half's bias to that of single precision
  constexpr std::uint32_t kLowest = 113U << 23;    // 2^-14
  const std::uint32_t magnitude = (half.bits & 0x7FFFU) << 13;
  const bool small = (half.bits & 0x7C00U) == 0;
  const float normal = std::bit_cast<float>(magnitude + kExponent);
  const float tiny = std::bit_cast<float>(magnitude + kLowest) - std::bit_cast<float>(kLowest);
  const std::uint32_t sign = (half.bits & 0x8000U) << 16;
  return std::bit_cast<float>(std::bit_cast<std::uint32_t>(small ? tiny : normal) | sign);
}

/// The nearest number, the even one of two. @param value below 65520 in magnitude
Half to_half(float value) noexcept;

/// Stored numbers as what they are computed with.
inline double to_double(float value) noexcept {
  return static_cast<double>(value);
}
inline double to_double(double value) noexcept {
  return value;
}
inline double to_double(std::int16_t value) noexcept {
  return static_cast<double>(value);
}
inline double to_double(Half value) noexcept {
  return static_cast<double>(to_float(value));
}

}  // namespace irdm
