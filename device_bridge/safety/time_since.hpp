#pragma once

#include <cstdint>

namespace irdm {

/// From one time to another [ns]. Exact for any two; of a time that goes back, longer than any gap.
inline std::uint64_t time_since(std::int64_t earlier_ns, std::int64_t now_ns) noexcept {
  return static_cast<std::uint64_t>(now_ns) - static_cast<std::uint64_t>(earlier_ns);
}

}  // namespace irdm
