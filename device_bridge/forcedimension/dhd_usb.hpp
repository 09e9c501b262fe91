#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace irdm::dhd {

/// A device of Force Dimension, or a Falcon, on USB.
struct UsbDevice {
  std::string node;        ///< "/dev/bus/usb/001/005"
  std::string usb_id;      ///< "1451:0402"
  bool permitted = false;  ///< this user may read and write it
};

/// Looks, with this process's rights; by node.
/// @param root folder that stands for "/"
std::vector<UsbDevice> find_usb_devices(const std::filesystem::path& root = "/");

/// The line of a udev rule that lets its users have this device. Pure.
/// @param usb_id as UsbDevice's
std::string udev_rule(const std::string& usb_id);

}  // namespace irdm::dhd
