#pragma once

#include <cstdint>
#include <span>

namespace irdm::fuzz {

/// The session in which the fuzzed ends of a connection are.
inline constexpr std::uint32_t kFuzzedSession = 7;

/// Puts the right checksum into every frame of a stream: the fuzzer would not guess it.
void mend(std::span<std::uint8_t> stream);

}  // namespace irdm::fuzz
