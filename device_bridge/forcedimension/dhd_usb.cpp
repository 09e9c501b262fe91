#include "device_bridge/forcedimension/dhd_usb.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <system_error>

namespace irdm::dhd {
namespace {

namespace fs = std::filesystem;

const std::string kForceDimension = "1451";  // vendor
const std::string kFalcon = "0403:cb48";     // of a vendor of many other devices

std::string first_word(const fs::path& path) {
  std::ifstream file(path);
  std::string word;
  file >> word;
  return word;
}

// As the kernel names the node: three digits each.
std::string three_digits(const fs::path& path) {
  int number = 0;
  std::ifstream(path) >> number;
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "%03d", number);
  return text.data();
}

}  // namespace

std::vector<UsbDevice> find_usb_devices(const fs::path& root) {
  std::vector<UsbDevice> devices;
  std::error_code none;
  for (const fs::directory_entry& entry :
       fs::directory_iterator(root / "sys/bus/usb/devices", none)) {
    const fs::path& folder = entry.path();
    const std::string id = first_word(folder / "idVendor") + ":" + first_word(folder / "idProduct");
    if (!id.starts_with(kForceDimension + ":") && id != kFalcon) continue;
    const fs::path node =
        root / "dev/bus/usb" / three_digits(folder / "busnum") / three_digits(folder / "devnum");
    devices.push_back({node.string(), id, ::access(node.c_str(), R_OK | W_OK) == 0});
  }
  std::sort(devices.begin(), devices.end(),
            [](const UsbDevice& a, const UsbDevice& b) { return a.node < b.node; });
  return devices;
}

std::string udev_rule(const std::string& usb_id) {
  const std::string product =
      usb_id == kFalcon ? "ATTR{idProduct}==\"" + usb_id.substr(5) + "\", " : "";
  return "SUBSYSTEM==\"usb\", ATTR{idVendor}==\"" + usb_id.substr(0, 4) + "\", " + product +
         "MODE=\"0660\", GROUP=\"plugdev\", TAG+=\"uaccess\"";
}

}  // namespace irdm::dhd
