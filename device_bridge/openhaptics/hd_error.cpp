#include "device_bridge/openhaptics/hd_error.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

namespace irdm::hd {

const char* const kPermissionRemedy =
    "install the udev rules of the vendor's driver for this model (91- or 99-3dsystems*.rules; "
    "they have to name its product id) or join the group that owns it, then plug the device in "
    "again";
const char* const kCommaRemedy =
    "write its numbers with decimal points, or set the device up again under LC_ALL=C";
const char* const kNameRemedy =
    "or leave `name` out: some drivers (2022) start their default device only";

const DeviceSetup* find_setup(const TouchSystem& system, const std::string& name) {
  const auto found = std::find_if(system.setups.begin(), system.setups.end(),
                                  [&](const DeviceSetup& setup) { return setup.name == name; });
  return found == system.setups.end() ? nullptr : &*found;
}

std::string setup_names(const TouchSystem& system) {
  std::string names;
  for (const DeviceSetup& setup : system.setups) names += (names.empty() ? "" : ", ") + setup.name;
  return names;
}

Advice start_advice(const std::string& name, const ErrorInfo& error, const TouchSystem& system) {
  const ErrorText& text = describe(error.code);
  const std::string refusal = "the driver does not start it: " + to_text(error);
  if (error.code == kAlreadyInitiated) return {refusal, text.remedy};
  const DeviceSetup* const setup = find_setup(system, name);
  if (!name.empty() && setup == nullptr && !system.setups.empty()) {
    return {
        "no device of this name is set up, only: " + setup_names(system),
        std::string("correct its name, set it up with the vendor's Touch_Setup, ") + kNameRemedy};
  }
  if (system.ports.empty()) {
    return {refusal + "; and no device of 3D Systems is on USB",
            "check power and cable; a device on the network or another bus has to be set up with "
            "the vendor's Touch_Setup"};
  }
  const auto closed = std::find_if(system.ports.begin(), system.ports.end(),
                                   [](const DevicePort& port) { return !port.permitted; });
  if (closed != system.ports.end()) {
    return {"no permission for " + closed->path, kPermissionRemedy};
  }
  if (setup != nullptr && setup->decimal_comma) {
    return {setup->file.string() + " has decimal commas", kCommaRemedy};
  }
  return {refusal, name.empty() ? text.remedy : std::string(text.remedy) + ", " + kNameRemedy};
}

}  // namespace irdm::hd

namespace irdm::hd {
namespace {

struct Entry {
  Code code;
  ErrorText text;
};

constexpr const char* kReport = "report it as a fault of irdm-bridge";
constexpr const char* kCable = "check power and cable of the device, and start irdm-bridge again";
constexpr const char* kAgain = "start irdm-bridge again to arm it";

constexpr std::array kEntries{
    Entry{0x0000, {"HD_SUCCESS", "no error", "nothing", Meaning::kNothing}},
    Entry{0x0100, {"HD_INVALID_ENUM", "a parameter it does not know", kReport, Meaning::kBadFrame}},
    Entry{0x0101,
          {"HD_INVALID_VALUE", "a value that it does not take", kReport, Meaning::kBadFrame}},
    Entry{0x0102,
          {"HD_INVALID_OPERATION", "not permitted at this time", kReport, Meaning::kBadFrame}},
    Entry{0x0103, {"HD_INVALID_INPUT_TYPE", "wrong type of value", kReport, Meaning::kBadFrame}},
    Entry{0x0104, {"HD_BAD_HANDLE", "the driver no longer knows it", kCable, Meaning::kLost}},
    Entry{0x0200, {"HD_WARM_MOTORS", "its motors are warm", "let them cool down", Meaning::kWarm}},
    Entry{0x0201, {"HD_EXCEEDED_MAX_FORCE", "more force than it bears", kAgain, Meaning::kWarning}},
    Entry{0x0202,
          {"HD_EXCEEDED_MAX_FORCE_IMPULSE", "force that changed too fast", kAgain,
           Meaning::kWarning}},
    Entry{0x0203, {"HD_EXCEEDED_MAX_VELOCITY", "it was moved too fast", kAgain, Meaning::kWarning}},
    Entry{0x0204,
          {"HD_FORCE_ERROR", "forces of different kinds in a frame", kReport, Meaning::kUnsafe}},
    Entry{0x0300, {"HD_DEVICE_FAULT", "the device does not work", kCable, Meaning::kLost}},
    Entry{0x0301,
          {"HD_DEVICE_ALREADY_INITIATED", "it is in use already",
           "close the other program, and name each device once", Meaning::kUnsafe}},
    Entry{0x0302,
          {"HD_COMM_ERROR", "communication with the device is lost", kCable, Meaning::kLost}},
    Entry{0x0303,
          {"HD_COMM_CONFIG_ERROR", "its connection is not set up",
           "set the device up with the vendor's Touch_Setup", Meaning::kLost}},
    Entry{0x0304,
          {"HD_TIMER_ERROR", "the driver's clock failed", "run fewer programs beside it",
           Meaning::kUnsafe}},
    Entry{0x0400, {"HD_ILLEGAL_BEGIN", "a frame in a frame", kReport, Meaning::kBadFrame}},
    Entry{0x0401, {"HD_ILLEGAL_END", "the end of no frame", kReport, Meaning::kBadFrame}},
    Entry{0x0402, {"HD_FRAME_ERROR", "a call outside of its frame", kReport, Meaning::kBadFrame}},
    Entry{0x0500, {"HD_INVALID_PRIORITY", "a priority out of range", kReport, Meaning::kUnsafe}},
    Entry{0x0501,
          {"HD_SCHEDULER_FULL", "too many callbacks are scheduled", "stop other users of libHD",
           Meaning::kUnsafe}},
    Entry{0x0600,
          {"HD_INVALID_LICENSE", "the vendor's licence is not valid",
           "install OpenHaptics with a licence", Meaning::kUnsafe}},
};

constexpr ErrorText kUnknown{"unknown error", "an error that irdm-bridge does not know", kAgain,
                             Meaning::kUnsafe};

}  // namespace

const ErrorText& describe(Code code) noexcept {
  const auto* const entry = std::find_if(kEntries.begin(), kEntries.end(),
                                         [code](const Entry& known) { return known.code == code; });
  return entry == kEntries.end() ? kUnknown : entry->text;
}

std::string to_text(const ErrorInfo& error) {
  const ErrorText& text = describe(error.code);
  std::array<char, 16> number{};
  std::snprintf(number.data(), number.size(), " 0x%04X", error.code);
  const std::string internal =
      error.internal == 0 ? "" : ", internal " + std::to_string(error.internal);
  return std::string(text.name) + number.data() + internal + ": " + text.what;
}

}  // namespace irdm::hd
