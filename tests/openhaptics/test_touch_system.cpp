#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "device_bridge/openhaptics/touch_system.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace irdm;
namespace fs = std::filesystem;

namespace {

/// A small /sys, /dev and /usr.
class FakeRoot {
 public:
  fs::path path(const std::string& name) const { return folder_.path() / name; }
  void write(const std::string& name, const std::string& text) const {
    fs::create_directories(path(name).parent_path());
    std::ofstream(path(name)) << text;
  }
  /// A node of a USB device, as the kernel shows it: the class' entry leads to the interface.
  void add_node(const std::string& kind, const std::string& node, const std::string& usb,
                const std::string& vendor, const std::string& product) const {
    write("sys/devices/" + usb + "/idVendor", vendor + "\n");
    write("sys/devices/" + usb + "/idProduct", product + "\n");
    fs::create_directories(path("sys/devices/" + usb + "/1.0"));
    fs::create_directories(path("sys/class/" + kind + "/" + node));
    fs::create_directory_symlink(path("sys/devices/" + usb + "/1.0"),
                                 path("sys/class/" + kind + "/" + node + "/device"));
    write("dev/" + node, "");
  }
  fs::path root() const { return folder_.path(); }

 private:
  test::TemporaryFolder folder_;
};

}  // namespace

TEST_CASE("ports of the vendor are found by their USB id, serial and HID") {
  const FakeRoot root;
  root.add_node("tty", "ttyACM0", "usb1", "2988", "0302");
  root.add_node("tty", "ttyUSB0", "usb2", "0403", "6001");
  root.add_node("hidraw", "hidraw1", "usb3", "2988", "0304");
  fs::create_directories(root.path("sys/class/tty/tty0"));  // no device behind it
  const auto ports = hd::find_ports("2988", root.root());
  REQUIRE(ports.size() == 2);
  CHECK(ports[0].path == root.path("dev/ttyACM0").string());
  CHECK(ports[0].usb_id == "2988:0302");
  CHECK(ports[0].permitted);
  CHECK(ports[1].usb_id == "2988:0304");
  fs::remove(root.path("dev/hidraw1"));
  CHECK_FALSE(hd::find_ports("2988", root.root())[1].permitted);
}

TEST_CASE("setups of the vendor are found, and decimal commas in them") {
  const FakeRoot root;
  root.write("home/config/Left.config",
             "[DEVICE]\nName=Left\nScale=1.5\nList=1,2,3\nOdd=1,\nEmpty=\n");
  root.write("home/config/notes.txt", "x=1,5\n");
  root.write("usr/share/3DSystems/config/Default Device.config", "[DEVICE]\nOffset = -1,5 \n");
  ::setenv("GTDD_HOME", root.path("home").c_str(), 1);
  const hd::TouchSystem system = hd::look_at_touch_system(root.root());
  ::unsetenv("GTDD_HOME");
  CHECK(system.ports.empty());
  CHECK(system.folders.front() == root.path("home/config"));
  const auto named = [&](const std::string& name) {
    for (const hd::DeviceSetup& setup : system.setups) {
      if (setup.name == name) return setup;
    }
    return hd::DeviceSetup{};
  };
  CHECK_FALSE(named("Left").decimal_comma);
  CHECK(named("Left").file == root.path("home/config/Left.config"));
  CHECK(named("Default Device").decimal_comma);
  CHECK(named("notes").name.empty());
}
