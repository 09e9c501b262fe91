#pragma once

#include <cstdint>

#include "common/geometry.hpp"
#include "common/realtime/triple_buffer.hpp"

namespace irdm::haply {

/// A state or a force that is older is of no use [ns].
inline constexpr std::int64_t kLongestAgeNs = 50'000'000;

/// The newest state of the device. Frame D.
struct InverseReading {
  std::int64_t time_ns = 0;      ///< when it came; 0: none yet
  std::uint64_t generation = 0;  ///< another one than before: the force begins anew
  bool ready = false;            ///< it may get a force
  Vector3 tip = Vector3::Zero();
  Quaternion orientation = Quaternion::Identity();
  std::uint32_t buttons = 0;
};

/// The newest force for it.
struct InverseForce {
  std::int64_t time_ns = 0;
  std::uint64_t generation = 0;     ///< of the reading that it goes with
  Vector3 force = Vector3::Zero();  ///< [N], D
};

/// Hand-over between servo thread and network thread. Neither ever waits for the other.
struct InverseMailbox {
  TripleBuffer<InverseReading> reading;  ///< network writes
  TripleBuffer<InverseForce> force;      ///< servo writes
};

}  // namespace irdm::haply
