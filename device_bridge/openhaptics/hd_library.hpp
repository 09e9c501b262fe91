#pragma once

#include <cstdint>
#include <string>
#include <vector>

/// The part of OpenHaptics' HDAPI that the bridge uses, as its binary interface is on 64-bit Linux.
/// Declarations of our own: nothing of the vendor's is needed to build. Lengths in mm, forces in N,
/// torques in mN m; +x right, +y up, +z towards the person.
namespace irdm::hd {

using Handle = std::uint32_t;
using Code = std::uint32_t;  ///< of an error
using Name = std::uint32_t;  ///< of a parameter or capability
using ScheduleHandle = unsigned long;
using Callback = std::uint32_t (*)(void*);

/// What hdGetError returns, by value.
struct ErrorInfo {
  Code code = 0;
  std::int32_t internal = 0;  ///< the driver's own number
  Handle device = 0;
};
static_assert(sizeof(ErrorInfo) == 12);

inline constexpr Handle kInvalidHandle = 0xFFFFFFFF;

inline constexpr std::uint32_t kCallbackDone = 0;
inline constexpr std::uint32_t kCallbackContinue = 1;
inline constexpr std::uint16_t kHighestPriority = 65535;

// Parameters: number and type of the values.
inline constexpr Name kButtons = 0x2000;             // 1 int, bits
inline constexpr Name kTransform = 0x2052;           // 16 double, column by column, mm
inline constexpr Name kModel = 0x2501;               // string
inline constexpr Name kSerialNumber = 0x2504;        // string
inline constexpr Name kOutputDof = 0x2554;           // 1 int; 6: force and torque
inline constexpr Name kCalibrationStyles = 0x2555;   // 1 int, bits
inline constexpr Name kMaxForce = 0x2603;            // 1 double [N]
inline constexpr Name kMaxContinuousForce = 0x2604;  // 1 double [N]
inline constexpr Name kMotorTemperature = 0x2605;    // 3 or 6 double, 0 cold to 1 warm
inline constexpr int kMotors = 6;
inline constexpr Name kMaxTorque = 0x2622;            // 1 double [mN m]
inline constexpr Name kMaxContinuousTorque = 0x2623;  // 1 double [mN m]
inline constexpr Name kForce = 0x2700;                // 3 double [N]
inline constexpr Name kTorque = 0x2701;               // 3 double [mN m]

// Capabilities.
inline constexpr Name kVelocityLimit = 0x2606;
inline constexpr Name kForceImpulseLimit = 0x2607;
inline constexpr Name kForceOutput = 0x4000;
inline constexpr Name kMaxForceClamping = 0x4001;
inline constexpr Name kForceLimit = 0x4003;

// Calibration: what hdCheckCalibration says, and the styles.
inline constexpr Name kCalibrationOk = 0x5000;
inline constexpr Name kCalibrationNeedsUpdate = 0x5001;
inline constexpr Name kCalibrationNeedsPerson = 0x5002;
inline constexpr Name kEncoderReset = 1;
inline constexpr Name kAuto = 2;
inline constexpr Name kInkwell = 4;

/// The functions, by what follows `hd` in their names. They throw nothing; what goes wrong is
/// learnt from get_error, which gives the newest error and forgets it.
struct Api {
  Handle (*init_device)(const char* name);
  void (*disable_device)(Handle);
  void (*make_current_device)(Handle);
  void (*begin_frame)(Handle);
  void (*end_frame)(Handle);
  ErrorInfo (*get_error)();
  void (*enable)(Name);
  void (*disable)(Name);
  unsigned char (*is_enabled)(Name);
  void (*get_integerv)(Name, std::int32_t*);
  void (*get_doublev)(Name, double*);
  const char* (*get_string)(Name);
  void (*set_doublev)(Name, const double*);
  Name (*check_calibration)();
  void (*update_calibration)(Name style);
  void (*start_scheduler)();
  void (*stop_scheduler)();
  void (*set_scheduler_rate)(unsigned long hertz);
  ScheduleHandle (*schedule_asynchronous)(Callback, void* data, std::uint16_t priority);
  void (*unschedule)(ScheduleHandle);
};

}  // namespace irdm::hd

namespace irdm::hd {

/// Where libHD.so is looked for, in this order: what $HD_LIBRARY names and nothing else, or the
/// usual names.
std::vector<std::string> library_names();

/// Loads the first of these libraries that is there. Throws Error that says what is missing: the
/// library, one that it needs, or a function in it.
Api load_library(const std::vector<std::string>& names);

/// The one of this process, loaded when first asked for. Throws as load_library().
const Api& library();

/// Which package brings a shared object that libHD.so needs, as advice. Pure.
std::string package_of(const std::string& object);

}  // namespace irdm::hd
