#include "common/half.hpp"

#include <cmath>

namespace irdm {

Half to_half(float value) noexcept {
  constexpr float kSmallest = 0x1p-24F;
  constexpr float kLowestNormal = 0x1p-14F;
  const auto sign =
      static_cast<std::uint16_t>((std::bit_cast<std::uint32_t>(value) >> 16) & 0x8000U);
  const float magnitude = std::abs(value);
  if (magnitude < kLowestNormal) {
    // Rounds to even, and the exponent comes by itself where it rounds up to the lowest normal.
    const float steps = std::nearbyint(magnitude / kSmallest);
    return {static_cast<std::uint16_t>(sign | static_cast<std::uint16_t>(steps))};
  }
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(magnitude);
  const std::uint32_t rounded = bits + 0xFFFU + ((bits >> 13) & 1U);
  return {static_cast<std::uint16_t>(sign | ((rounded - (112U << 23)) >> 13))};
}

}  // namespace irdm
