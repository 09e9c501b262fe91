#include "device_bridge/openhaptics/touch_system.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <system_error>

namespace irdm::hd {
namespace {

namespace fs = std::filesystem;

const char* const kVendor = "2988";  // 3D Systems

std::vector<fs::path> entries(const fs::path& folder) {
  std::vector<fs::path> found;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) found.push_back(entry.path());
  std::sort(found.begin(), found.end());
  return found;
}

std::string first_line(const fs::path& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

// The USB device is one of the folders above the interface that the node belongs to.
std::string usb_id(const fs::path& sys_entry) {
  std::error_code error;
  fs::path folder = fs::canonical(sys_entry / "device", error);
  if (error) return "";
  for (; folder.has_relative_path(); folder = folder.parent_path()) {
    const std::string vendor = first_line(folder / "idVendor");
    if (!vendor.empty()) return vendor + ":" + first_line(folder / "idProduct");
  }
  return "";
}

std::vector<fs::path> setup_folders(const fs::path& root) {
  std::vector<fs::path> folders;
  if (const char* const home = std::getenv("GTDD_HOME"))
    folders.push_back(fs::path(home) / "config");
  if (const char* const home = std::getenv("HOME")) {
    folders.push_back(fs::path(home) / ".3dsystems" / "config");
  }
  folders.push_back(root / "usr/share/3DSystems/config");
  return folders;
}

std::size_t digits_from(const std::string& text, std::size_t begin) {
  const std::size_t end = std::min(text.find_first_not_of("0123456789", begin), text.size());
  return end - begin;
}

// "1,5", with a sign or without, and nothing else: two numbers with a comma between are a list only
// where there are more of them.
bool is_comma_number(const std::string& value) {
  const std::size_t whole = value.find_first_of("-+") == 0 ? 1 : 0;
  const std::size_t comma = whole + digits_from(value, whole);
  if (comma == whole || comma >= value.size() || value[comma] != ',') return false;
  const std::size_t fraction = digits_from(value, comma + 1);
  return fraction > 0 && comma + 1 + fraction == value.size();
}

bool has_decimal_comma(const fs::path& path) {
  const char* const blanks = " \t\r";
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    const std::size_t equals = line.find('=');
    if (equals == std::string::npos) continue;
    const std::size_t begin = line.find_first_not_of(blanks, equals + 1);
    if (begin == std::string::npos) continue;
    const std::size_t end = line.find_last_not_of(blanks) + 1;
    if (is_comma_number(line.substr(begin, end - begin))) return true;
  }
  return false;
}

}  // namespace

std::vector<DevicePort> find_ports(const std::string& vendor, const fs::path& root) {
  std::vector<DevicePort> ports;
  for (const char* const kind : {"tty", "hidraw"}) {
    for (const fs::path& entry : entries(root / "sys/class" / kind)) {
      const std::string id = usb_id(entry);
      if (!id.starts_with(vendor + ":")) continue;
      const fs::path node = root / "dev" / entry.filename();
      ports.push_back({node.string(), id, ::access(node.c_str(), R_OK | W_OK) == 0});
    }
  }
  return ports;
}

TouchSystem look_at_touch_system(const fs::path& root) {
  TouchSystem system{.ports = find_ports(kVendor, root), .folders = setup_folders(root)};
  for (const fs::path& folder : system.folders) {
    for (const fs::path& file : entries(folder)) {
      if (file.extension() != ".config") continue;
      system.setups.push_back({file.stem().string(), file, has_decimal_comma(file)});
    }
  }
  return system;
}

}  // namespace irdm::hd
