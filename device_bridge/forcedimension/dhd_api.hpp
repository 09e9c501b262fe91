#pragma once

#include <string>
#include <vector>

/// The part of Force Dimension's DHD that the bridge uses, as its binary interface is on Linux.
/// Declarations of our own: nothing of the vendor's is needed to build. Lengths in m, forces in N,
/// torques in N m; +x towards the person, +y right, +z up.
namespace irdm::dhd {

/// The functions, by what follows `dhd` in their names. A result below zero is a failure, in words
/// by error_get_last_str.
struct Api {
  int (*open)();
  int (*open_id)(char index);
  int (*close)(char id);
  int (*enable_force)(unsigned char on, char id);
  const char* (*get_system_name)(char id);
  int (*get_position)(double* x, double* y, double* z, char id);
  int (*get_orientation_frame)(double rows[3][3], char id);
  unsigned (*get_button_mask)(char id);
  bool (*has_active_wrist)(char id);  ///< it renders torque
  int (*set_force)(double x, double y, double z, char id);
  /// Force and then torque; of a device with an active wrist.
  int (*set_force_and_torque)(double fx, double fy, double fz, double tx, double ty, double tz,
                              char id);
  const char* (*error_get_last_str)();
};

/// Where it is looked for: what $FORCEDIMENSION_LIB names and nothing else, or the usual names.
std::vector<std::string> library_names();

/// Loads the first of these libraries that is there. Throws Error that says what is missing.
Api load_library(const std::vector<std::string>& names);

/// The one of this process, loaded when first asked for. Throws as load_library().
const Api& library();

}  // namespace irdm::dhd
