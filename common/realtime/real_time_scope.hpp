#pragma once

#include "common/realtime/no_denormals.hpp"
#include "common/realtime/scheduling.hpp"

namespace irdm {

/// What a real-time thread does for itself before its first step: it takes a name for those who
/// look at threads, touches the stack that its steps will need, keeps it in RAM where memory is to
/// be locked, and computes without denormal numbers as long as this object exists.
class RealTimeScope {
 public:
  /// @param name at most 15 letters
  RealTimeScope(const char* name, RealTimeScheduling wanted) noexcept;

 private:
  NoDenormals no_denormals_;
};

}  // namespace irdm
