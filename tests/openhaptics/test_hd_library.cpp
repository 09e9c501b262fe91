#include <cstdlib>

#include "common/error.hpp"
#include "device_bridge/driver_library.hpp"
#include "device_bridge/openhaptics/hd_library.hpp"
#include "tests/support/catch.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;

TEST_CASE("libHD.so is looked for by its usual names, or by the one that is given alone") {
  ::unsetenv("HD_LIBRARY");
  CHECK(hd::library_names() == std::vector<std::string>{"libHD.so.3.4", "libHD.so.3", "libHD.so"});
  ::setenv("HD_LIBRARY", "/opt/libHD.so", 1);
  CHECK(hd::library_names() == std::vector<std::string>{"/opt/libHD.so"});
  ::unsetenv("HD_LIBRARY");
}

TEST_CASE("libHD.so is loaded with all its functions, the next name after one that is not there") {
  const hd::Api api = hd::load_library({"libHD.so.not-there", IRDM_FAKE_LIBHD});
  CHECK(api.init_device != nullptr);
  CHECK(api.unschedule != nullptr);
  CHECK(api.get_error().code == 0);
}

TEST_CASE("a missing libHD.so is told with all names that were tried") {
  CHECK_THROWS_WITH(hd::load_library({"libHD.so.no", "/nowhere/libHD.so"}),
                    ContainsSubstring("libHD.so.no, /nowhere/libHD.so") &&
                        ContainsSubstring("install the 64-bit OpenHaptics"));
  CHECK_THROWS_AS(hd::load_library({"/nowhere/libHD.so"}), Error);
}

TEST_CASE("a libHD.so that lacks a library of its own names it and what brings it") {
  CHECK_THROWS_WITH(hd::load_library({IRDM_LONELY_LIBHD, IRDM_FAKE_LIBHD}),
                    ContainsSubstring("is there, but needs libPhantomIOLib42.so") &&
                        ContainsSubstring("device driver"));
}

TEST_CASE("a libHD.so that lacks a function names it") {
  CHECK_THROWS_WITH(hd::load_library({IRDM_BROKEN_LIBHD}), ContainsSubstring("has no function hd"));
}

TEST_CASE("a file that is no library is told in dlopen's words") {
  CHECK_THROWS_WITH(hd::load_library({IRDM_SOURCE_DIR "/README.md"}),
                    ContainsSubstring("README.md cannot be loaded") && ContainsSubstring("64-bit"));
}

TEST_CASE("what dlopen misses is read from its message") {
  CHECK(missing_object("libx.so.5: cannot open shared object file: No such file") == "libx.so.5");
  CHECK(missing_object("libx.so: wrong ELF class: ELFCLASS32").empty());
  CHECK_THAT(hd::package_of("libncurses.so.5"), ContainsSubstring("libncurses5"));
  CHECK_THAT(hd::package_of("libtinfo.so.5"), ContainsSubstring("libtinfo5"));
  CHECK_THAT(hd::package_of("libother.so"), ContainsSubstring("LD_LIBRARY_PATH"));
}
