#include <filesystem>
#include <fstream>
#include <string>

#include "device_bridge/forcedimension/dhd_usb.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace irdm;
namespace fs = std::filesystem;

namespace {

/// A small /sys and /dev. USB ids: those of devices of Force Dimension (1451) and of the Falcon
/// (0403:cb48, of a vendor whose other devices are none of ours), as in public udev rules.
class FakeRoot {
 public:
  fs::path path(const std::string& name) const { return folder_.path() / name; }
  void write(const std::string& name, const std::string& text) const {
    fs::create_directories(path(name).parent_path());
    std::ofstream(path(name)) << text;
  }
  void add(const std::string& name, const std::string& vendor, const std::string& product,
           const std::string& device) const {
    const std::string folder = "sys/bus/usb/devices/" + name;
    write(folder + "/idVendor", vendor + "\n");
    write(folder + "/idProduct", product + "\n");
    write(folder + "/busnum", "3\n");
    write(folder + "/devnum", device + "\n");
  }
  fs::path root() const { return folder_.path(); }

 private:
  test::TemporaryFolder folder_;
};

}  // namespace

TEST_CASE("devices of Force Dimension and Falcons are found on USB, with their permission") {
  const FakeRoot root;
  CHECK(dhd::find_usb_devices(root.root()).empty());
  root.add("3-2", "0403", "cb48", "17");
  root.add("3-1", "1451", "0402", "5");
  root.add("3-3", "0403", "6001", "18");  // a serial converter
  root.add("usb3", "1d6b", "0002", "1");
  fs::create_directories(root.path("sys/bus/usb/devices/3-1:1.0"));  // an interface
  root.write("dev/bus/usb/003/017", "");
  const auto devices = dhd::find_usb_devices(root.root());
  REQUIRE(devices.size() == 2);
  CHECK(devices[0].node == root.path("dev/bus/usb/003/005").string());
  CHECK(devices[0].usb_id == "1451:0402");
  CHECK_FALSE(devices[0].permitted);
  CHECK(devices[1].node == root.path("dev/bus/usb/003/017").string());
  CHECK(devices[1].usb_id == "0403:cb48");
  CHECK(devices[1].permitted);
}

TEST_CASE("the udev rule is that of the vendor, of a Falcon that of the product") {
  CHECK(dhd::udev_rule("1451:0402") ==
        "SUBSYSTEM==\"usb\", ATTR{idVendor}==\"1451\", MODE=\"0660\", GROUP=\"plugdev\", "
        "TAG+=\"uaccess\"");
  CHECK(dhd::udev_rule("0403:cb48") ==
        "SUBSYSTEM==\"usb\", ATTR{idVendor}==\"0403\", ATTR{idProduct}==\"cb48\", MODE=\"0660\", "
        "GROUP=\"plugdev\", TAG+=\"uaccess\"");
}
