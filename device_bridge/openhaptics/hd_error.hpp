#pragma once

#include <string>

#include "device_bridge/openhaptics/hd_library.hpp"
#include "device_bridge/openhaptics/touch_system.hpp"

namespace irdm::hd {

/// What an error of the driver means for the force, from harmless to worst.
enum class Meaning {
  kNothing,   ///< no error
  kWarm,      ///< the motors are warm: less force for a while
  kBadFrame,  ///< what this frame read is of no use; several in a row are a fault of the reading
  kWarning,   ///< a force or speed was too much: no force for a while
  kUnsafe,    ///< no force any more; readings go on
  kLost,      ///< no force, and no readings any more
};

/// An error in words.
struct ErrorText {
  const char* name;    ///< as the vendor's documents have it
  const char* what;    ///< what is wrong
  const char* remedy;  ///< what to do
  Meaning meaning;     ///< when it comes while the device runs
};

/// Unknown codes are unsafe. Real-time safe.
const ErrorText& describe(Code code) noexcept;

inline constexpr Code kSuccess = 0x0000;
inline constexpr Code kInvalidValue = 0x0101;
inline constexpr Code kWarmMotors = 0x0200;
inline constexpr Code kDeviceFault = 0x0300;
inline constexpr Code kAlreadyInitiated = 0x0301;
inline constexpr Code kCommunication = 0x0302;
inline constexpr Code kCommunicationConfig = 0x0303;

/// "NAME 0x0302, internal 5: WHAT".
std::string to_text(const ErrorInfo& error);

}  // namespace irdm::hd

namespace irdm::hd {

/// What is wrong, and what to do about it.
struct Advice {
  std::string what;
  std::string remedy;
};

/// Why the driver does not start a device: its error says little, so what the system knows is
/// looked at first. Pure.
/// @param name as configured; empty: the driver's default device
Advice start_advice(const std::string& name, const ErrorInfo& error, const TouchSystem& system);

/// The setup of a device of this name; nullptr: none. An empty name: none either. Pure.
const DeviceSetup* find_setup(const TouchSystem& system, const std::string& name);

/// "A, B" of all setups. Pure.
std::string setup_names(const TouchSystem& system);

extern const char* const kPermissionRemedy;
extern const char* const kCommaRemedy;
extern const char* const kNameRemedy;

}  // namespace irdm::hd
