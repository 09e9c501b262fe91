#include <filesystem>
#include <fstream>
#include <string>

#include "common/error.hpp"
#include "device_bridge/bridge_config.hpp"
#include "device_bridge/haply/haply_device.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::test;

namespace {

BridgeConfig load(const std::string& text) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "bridge.toml") << text;
  return load_bridge_config(folder.path() / "bridge.toml");
}

const std::string kHaply = "[[device]]\ntype = \"haply\"\n";

}  // namespace

TEST_CASE("a Haply device is named by its id and the service's address, which has a default") {
  const BridgeConfig config = load("[bridge]\nrealtime = \"ignore\"\n" + kHaply +
                                   "name = \"049D\"\nservice = \"[::1]:8500\"\ngrip = \"61576\"\n"
                                   "shared = true\n");
  const haply::InverseSettings settings = inverse_settings(config.devices.at(0));
  CHECK(settings.service.host == "::1");
  CHECK(settings.service.port == 8500);
  CHECK(settings.device == "049D");
  CHECK(settings.grip == "61576");
  CHECK(settings.shared);
  CHECK(settings.scheduling == RealTimeScheduling::kIgnore);
  const haply::InverseSettings usual = inverse_settings(load(kHaply).devices.at(0));
  CHECK(usual.service.host == "localhost");
  CHECK(usual.service.port == 10001);
  CHECK(usual.device.empty());
  CHECK_FALSE(usual.shared);
}

TEST_CASE("what a configuration says wrongly of a Haply device is told in one line") {
  CHECK_THROWS_WITH(
      load(kHaply + "service = \"localhost\"\n"),
      ContainsSubstring("bridge.toml: device.service: 'localhost' has no port; give HOST:PORT"));
  CHECK_THROWS_WITH(load(kHaply + "service = \"localhost:0\"\n"),
                    ContainsSubstring("is not a server"));
  CHECK_THROWS_WITH(load(kHaply + "service = 10001\n"), ContainsSubstring("service is not text"));
  CHECK_THROWS_WITH(load("[[device]]\ntype = \"openhaptics\"\nservice = \"a:1\"\n"),
                    ContainsSubstring("service is for devices of type haply; remove it"));
  CHECK_THROWS_WITH(load("[[device]]\ntype = \"openhaptics\"\ngrip = \"1\"\n"),
                    ContainsSubstring("grip is for devices of type haply; remove it"));
  CHECK_THROWS_WITH(load("[[device]]\ntype = \"openhaptics\"\nshared = true\n"),
                    ContainsSubstring("shared is for devices of type haply; remove it"));
  CHECK_THROWS_WITH(load(kHaply + kHaply),
                    ContainsSubstring("two devices of type haply with the name ''"));
  CHECK_THROWS_WITH(load(kHaply + "auto_init = true\n"),
                    ContainsSubstring("is for devices of Force Dimension"));
  CHECK_NOTHROW(load(kHaply + kHaply + "service = \"other:10001\"\n"));
}
