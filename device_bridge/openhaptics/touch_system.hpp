#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace irdm::hd {

/// A device node behind which a haptic device is.
struct DevicePort {
  std::string path;        ///< "/dev/ttyACM0"
  std::string usb_id;      ///< "2988:0302"
  bool permitted = false;  ///< this user may read and write it
};

/// A device that the vendor's setup program has set up: NAME.config in one of its folders.
struct DeviceSetup {
  std::string name;
  std::filesystem::path file;
  bool decimal_comma = false;  ///< it holds a number with a comma, which the driver misreads
};

/// What the operating system knows of haptic devices of 3D Systems.
struct TouchSystem {
  std::vector<DevicePort> ports = {};
  std::vector<std::filesystem::path> folders = {};  ///< where setups were looked for
  std::vector<DeviceSetup> setups = {};
};

/// Looks, with this process's rights.
/// @param root folder that stands for "/"
TouchSystem look_at_touch_system(const std::filesystem::path& root = "/");

/// The device nodes of a USB vendor, four hexadecimal digits.
std::vector<DevicePort> find_ports(const std::string& vendor, const std::filesystem::path& root);

}  // namespace irdm::hd
