#include <cstdlib>

#include "device_bridge/driver_library.hpp"
#include "device_bridge/forcedimension/dhd_api.hpp"

namespace irdm::dhd {

std::vector<std::string> library_names() {
  const char* const chosen = std::getenv("FORCEDIMENSION_LIB");
  if (chosen != nullptr && *chosen != '\0') return {chosen};
  return {"libdhd.so.3", "libdhd.so", "libdrd.so.3", "libdrd.so"};
}

Api load_library(const std::vector<std::string>& names) {
  const std::string install =
      "install the 64-bit Force Dimension SDK 3, or name its libdhd.so in $FORCEDIMENSION_LIB";
  const DriverLibrary library({.vendor = "Force Dimension",
                               .names = names,
                               .install = install,
                               .package_of = [](const std::string& object) {
                                 return object.starts_with("libusb-1.0")
                                            ? std::string("install the Debian package libusb-1.0-0")
                                            : "install what brings " + object;
                               }});
  Api api{};
  library.bind("dhdOpen", api.open);
  library.bind("dhdOpenID", api.open_id);
  library.bind("dhdClose", api.close);
  library.bind("dhdEnableForce", api.enable_force);
  library.bind("dhdGetSystemName", api.get_system_name);
  library.bind("dhdGetPosition", api.get_position);
  library.bind("dhdGetOrientationFrame", api.get_orientation_frame);
  library.bind("dhdGetButtonMask", api.get_button_mask);
  library.bind("dhdHasActiveWrist", api.has_active_wrist);
  library.bind("dhdSetForce", api.set_force);
  library.bind("dhdSetForceAndTorque", api.set_force_and_torque);
  library.bind("dhdErrorGetLastStr", api.error_get_last_str);
  return api;
}

const Api& library() {
  static const Api kApi = load_library(library_names());
  return kApi;
}

}  // namespace irdm::dhd
