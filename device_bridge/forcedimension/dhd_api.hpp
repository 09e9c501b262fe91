#pragma once

#include <string>
#include <vector>

/// The part of Force Dimension's DHD that the bridge uses, as its binary interface is on Linux.
/// Declarations of our own: nothing of the vendor's is needed to build. Lengths in m, forces in N,
/// torques in N m; +x towards the person, +y right, +z up.
namespace irdm::dhd {

inline constexpr int kRepeated = 1;     ///< a reading is that of a moment ago (time guard)
inline constexpr int kSaturated = 2;    ///< a force was more than the motors give
inline constexpr int kStatusRoom = 32;  ///< of which releases of the driver write 15 to 17

/// Where get_status writes what.
enum Status { kInitialised = 3, kForceOn = 5, kForceOffCause = 14 };

/// Why the device has turned its force off.
enum class ForceOff {
  kNone = 0,
  kButton = 1,    ///< the person's
  kVelocity = 2,  ///< the end effector was too fast
  kWatchdog = 3,  ///< the host was silent
  kSoftware = 4,
  kUnplugged = 5,
  kDeadman = 6,  ///< the handle was let go
};

/// The functions, by what follows `dhd` (`drd`) in their names. A result below zero is a failure,
/// in words by error_get_last_str.
struct Api {
  int (*open)();
  int (*open_id)(char index);
  int (*open_serial)(int serial);
  int (*close)(char id);
  int (*get_serial_number)(unsigned short* serial, char id);
  const char* (*get_system_name)(char id);
  int (*get_system_type)(char id);
  int (*get_status)(int* status, char id);  ///< kStatusRoom numbers
  int (*enable_force)(unsigned char on, char id);
  int (*set_gravity_compensation)(int on, char id);
  int (*get_position_and_orientation_frame)(double* x, double* y, double* z, double rows[3][3],
                                            char id);
  unsigned (*get_button_mask)(char id);
  bool (*has_gripper)(char id);
  bool (*has_active_wrist)(char id);  ///< it renders torque
  /// Closing the gripper counts as a button. Null: the driver is too old.
  int (*emulate_button)(unsigned char on, char id);
  /// The driver cuts forces off there [N]. Null: too old.
  int (*set_max_force)(double limit, char id);
  int (*set_force_and_torque_and_gripper_force)(double fx, double fy, double fz, double tx,
                                                double ty, double tz, double fg, char id);
  const char* (*error_get_last_str)();
  /// Moves the arm to its stops and counts from there. Null: the library is not libdrd.
  int (*auto_init)(char id);
};

/// Where it is looked for: what $FORCEDIMENSION_LIB names and nothing else; or the SDK in $FDSDK,
/// ~/.local/lib and the system, libdrd before libdhd, which it contains, the newest first.
std::vector<std::string> library_names();

/// Loads the first of these libraries that is there. Throws Error that says what is missing.
Api load_library(const std::vector<std::string>& names);

/// The one of this process, loaded when first asked for. Throws as load_library().
const Api& library();

}  // namespace irdm::dhd
