#pragma once

#include "common/realtime/clock.hpp"

namespace irdm::test {

inline constexpr std::int64_t kMs = kNanosecondsPerMillisecond;

}  // namespace irdm::test
