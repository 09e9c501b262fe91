#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "device_bridge/driver_library.hpp"
#include "device_bridge/forcedimension/dhd_api.hpp"

namespace irdm::dhd {
namespace {

namespace fs = std::filesystem;

// As SDKs ship them: without the links that the loader would look for.
void add_versions(const fs::path& folder, std::vector<std::string>& names) {
  for (const char* const stem : {"libdrd.so", "libdhd.so"}) {
    std::vector<std::string> found;
    std::error_code none;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, none)) {
      if (entry.path().filename().string().starts_with(stem))
        found.push_back(entry.path().string());
    }
    std::sort(found.begin(), found.end(), [](const std::string& a, const std::string& b) {
      return a.size() != b.size() ? a.size() > b.size() : a > b;  // 3.17 before 3.9
    });
    names.insert(names.end(), found.begin(), found.end());
  }
}

fs::path folder_of(const char* variable) {
  const char* const value = std::getenv(variable);
  return value != nullptr ? value : "";
}

}  // namespace

std::vector<std::string> library_names() {
  const fs::path chosen = folder_of("FORCEDIMENSION_LIB");
  if (!chosen.empty()) return {chosen.string()};
  std::vector<std::string> names;
  if (const fs::path sdk = folder_of("FDSDK"); !sdk.empty()) {
    for (const char* const below : {"lib/release/lin-x86_64-gcc", "lib", ""}) {
      add_versions(sdk / below, names);
    }
  }
  if (const fs::path home = folder_of("HOME"); !home.empty()) {
    add_versions(home / ".local/lib", names);
  }
  for (const char* const folder : {"/usr/local/lib", "/usr/lib"}) add_versions(folder, names);
  for (const char* const name : {"libdrd.so.3", "libdrd.so", "libdhd.so.3", "libdhd.so"}) {
    names.emplace_back(name);
  }
  return names;
}

Api load_library(const std::vector<std::string>& names) {
  const std::string install =
      "install the 64-bit Force Dimension SDK 3 and set $FDSDK to its folder, or name its library "
      "in $FORCEDIMENSION_LIB";
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
  library.bind("dhdOpenSerial", api.open_serial);
  library.bind("dhdClose", api.close);
  library.bind("dhdGetSerialNumber", api.get_serial_number);
  library.bind("dhdGetSystemName", api.get_system_name);
  library.bind("dhdGetSystemType", api.get_system_type);
  library.bind("dhdGetStatus", api.get_status);
  library.bind("dhdEnableForce", api.enable_force);
  library.bind("dhdSetGravityCompensation", api.set_gravity_compensation);
  library.bind("dhdGetPositionAndOrientationFrame", api.get_position_and_orientation_frame);
  library.bind("dhdGetButtonMask", api.get_button_mask);
  library.bind("dhdHasGripper", api.has_gripper);
  library.bind("dhdHasActiveWrist", api.has_active_wrist);
  library.bind("dhdSetForceAndTorqueAndGripperForce", api.set_force_and_torque_and_gripper_force);
  library.bind("dhdErrorGetLastStr", api.error_get_last_str);
  library.bind_if_there("dhdEmulateButton", api.emulate_button);
  library.bind_if_there("dhdSetMaxForce", api.set_max_force);
  library.bind_if_there("drdAutoInit", api.auto_init);
  return api;
}

const Api& library() {
  static const Api kApi = load_library(library_names());
  return kApi;
}

}  // namespace irdm::dhd
