#pragma once

#include <cstdint>

#include "common/geometry.hpp"

namespace irdm {

/// Bit 0 of StylusSample::buttons is the grab button.
inline constexpr std::uint32_t kGrabButton = 1u << 0;
/// Bit 1 is the reset button: when it goes down, every object is reset.
inline constexpr std::uint32_t kResetButton = 1u << 1;

/// What a bridge knows of one stylus at one moment.
struct StylusSample {
  std::uint64_t sequence = 0;  ///< strictly increasing from 0; in lockstep the number of the step
  std::int64_t time_ns = 0;    ///< the bridge's monotonic clock when it was taken
  std::uint32_t buttons = 0;   ///< kGrabButton, kResetButton; other bits mean nothing
  Vector3 tip = Vector3::Zero();                    ///< [m], W
  Quaternion orientation = Quaternion::Identity();  ///< of the stylus in W
};

/// State of a stylus' contact, numbered as in the trace file.
enum class ContactState : std::uint8_t { kFree = 0, kTouching = 1, kHeld = 2 };

/// The server's answer to one stylus sample.
struct StylusForce {
  std::uint64_t force_step = 0;       ///< k, the step that this force was computed in
  std::uint64_t sample_sequence = 0;  ///< of the sample that it answers
  std::int64_t sample_time_ns = 0;    ///< that sample's time_ns, unchanged
  ContactState contact = ContactState::kFree;
  Vector3 force = Vector3::Zero();  ///< on the stylus [N], W
  Vector3 proxy = Vector3::Zero();  ///< the god-object: where the tip is held by the surface [m], W
  Vector3 torque = Vector3::Zero();  ///< on the stylus about its tip [N m], W; 0 without a tool
};

}  // namespace irdm
