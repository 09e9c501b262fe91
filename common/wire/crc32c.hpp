#pragma once

#include <cstdint>
#include <span>

namespace irdm::wire {

/// CRC32C (Castagnoli: polynomial 0x1EDC6F41, reflected, start and final xor all ones) of `first`
/// followed by `second`.
std::uint32_t crc32c(std::span<const std::uint8_t> first,
                     std::span<const std::uint8_t> second = {}) noexcept;

}  // namespace irdm::wire
