#include "device_bridge/openhaptics/hd_library.hpp"

#include <cstdlib>

#include "device_bridge/driver_library.hpp"

namespace irdm::hd {

std::vector<std::string> library_names() {
  const char* const chosen = std::getenv("HD_LIBRARY");
  if (chosen != nullptr && *chosen != '\0') return {chosen};
  return {"libHD.so.3.4", "libHD.so.3", "libHD.so"};
}

std::string package_of(const std::string& object) {
  if (object.starts_with("libPhantomIOLib") || object.starts_with("libPHANToMIO") ||
      object.starts_with("libPhantomManager")) {
    return "install the vendor's device driver (Touch Device Driver for Linux)";
  }
  for (const std::string name : {"libncurses", "libtinfo"}) {
    if (object.starts_with(name + ".so.5")) {
      return "install the package " + name + "5 (Debian 12 has it, later releases may not)";
    }
  }
  return "install what brings it, or add its folder to LD_LIBRARY_PATH";
}

Api load_library(const std::vector<std::string>& names) {
  const DriverLibrary library(
      {.vendor = "OpenHaptics",
       .names = names,
       .install =
           "install the 64-bit OpenHaptics 3.4 of 3D Systems with its device driver, or name "
           "its libHD.so in $HD_LIBRARY",
       .package_of = package_of});
  Api api{};
  library.bind("hdInitDevice", api.init_device);
  library.bind("hdDisableDevice", api.disable_device);
  library.bind("hdMakeCurrentDevice", api.make_current_device);
  library.bind("hdBeginFrame", api.begin_frame);
  library.bind("hdEndFrame", api.end_frame);
  library.bind("hdGetError", api.get_error);
  library.bind("hdEnable", api.enable);
  library.bind("hdDisable", api.disable);
  library.bind("hdIsEnabled", api.is_enabled);
  library.bind("hdGetIntegerv", api.get_integerv);
  library.bind("hdGetDoublev", api.get_doublev);
  library.bind("hdGetString", api.get_string);
  library.bind("hdSetDoublev", api.set_doublev);
  library.bind("hdCheckCalibration", api.check_calibration);
  library.bind("hdUpdateCalibration", api.update_calibration);
  library.bind("hdStartScheduler", api.start_scheduler);
  library.bind("hdStopScheduler", api.stop_scheduler);
  library.bind("hdSetSchedulerRate", api.set_scheduler_rate);
  library.bind("hdScheduleAsynchronous", api.schedule_asynchronous);
  library.bind("hdUnschedule", api.unschedule);
  return api;
}

const Api& library() {
  static const Api kApi = load_library(library_names());
  return kApi;
}

}  // namespace irdm::hd
