#include <filesystem>
#include <fstream>
#include <string>

#include "common/error.hpp"
#include "device_bridge/bridge_config.hpp"
#include "device_bridge/device_registry.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;

namespace {

/// A configuration file for the length of a test.
class ConfigFile {
 public:
  explicit ConfigFile(const std::string& text)
      : path_(std::filesystem::temp_directory_path() /
              ("irdm-bridge-config-" + std::to_string(reinterpret_cast<std::uintptr_t>(this)) +
               ".toml")) {
    std::ofstream(path_) << text;
  }
  ~ConfigFile() { std::filesystem::remove(path_); }
  BridgeConfig load(const BridgeOverrides& overrides = {}) const {
    return load_bridge_config(path_, overrides);
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

const std::string kDevice = "[[device]]\nscript = \"a.csv\"\n";

void check_refused(const std::string& text, const std::string& words,
                   const BridgeOverrides& overrides = {}) {
  const ConfigFile file(text);
  CHECK_THROWS_AS(file.load(overrides), Error);
  CHECK_THROWS_WITH(file.load(overrides), Catch::Matchers::ContainsSubstring(words));
}

}  // namespace

TEST_CASE("bridge configuration has defaults for all but the script") {
  const ConfigFile file(kDevice);
  const BridgeConfig config = file.load();
  CHECK_FALSE(config.server);
  CHECK(config.rate == 1000.0);
  CHECK(config.max_force == 3.3);
  CHECK(config.max_torque == 0.15);
  CHECK(config.continuous_torque == 0.05);
  CHECK(config.max_torque_rate == 15.0);
  CHECK(config.connect_timeout == 0.075);
  CHECK_FALSE(config.udp);
  CHECK(config.predict);
  CHECK(BridgeConfig().predict == config.predict);
  REQUIRE(config.devices.size() == 1);
  CHECK(config.devices[0].type == "virtual");
  CHECK(config.devices[0].script == file.path().parent_path() / "a.csv");
  CHECK_FALSE(config.devices[0].hand);
  const auto& [workspace, buttons] = config.devices[0].mapping;
  CHECK(workspace.position == Vector3(0, 0, 0));
  CHECK(workspace.rotation.coeffs() == Quaternion::Identity().coeffs());
  CHECK(workspace.scale == 1.0);
  CHECK(workspace.force_scale == 1.0);
  CHECK(buttons.grab == 0);
  CHECK(buttons.clutch == 1);
  CHECK(buttons.reset == 2);
}

TEST_CASE("bridge configuration takes workspace and buttons of a device") {
  const BridgeConfig config =
      ConfigFile(kDevice +
                 "workspace = { position = [1, 2, 3], rotation = [0, 0, 2, 0], scale = 4, "
                 "force_scale = 0.5 }\nbuttons = { grab = 3, clutch = -1, reset = 31 }\n" +
                 kDevice + "buttons = { grab = -1, clutch = -1 }\n")
          .load();
  const auto& [workspace, buttons] = config.devices.at(0).mapping;
  CHECK(workspace.position == Vector3(1, 2, 3));
  CHECK(workspace.rotation.coeffs() == Quaternion(0, 0, 1, 0).coeffs());
  CHECK(workspace.scale == 4.0);
  CHECK(workspace.force_scale == 0.5);
  CHECK(buttons.grab == 3);
  CHECK(buttons.clutch == ButtonMap::kNone);
  CHECK(buttons.reset == 31);
  CHECK(config.devices.at(1).mapping.buttons.reset == 2);
}

TEST_CASE("bridge configuration refuses a workspace or buttons that do not fit") {
  check_refused(kDevice + "workspace = 1\n", "not a table");
  check_refused(kDevice + "workspace = { position = [0, 0] }\n", "position has 2 entries");
  check_refused(kDevice + "workspace = { position = [0, 0, 101] }\n", "position is 101");
  check_refused(kDevice + "workspace = { rotation = [0, 0, 0, 0] }\n", "rotation has no length");
  check_refused(kDevice + "workspace = { rotation = [1, 0, 0] }\n", "rotation has 3 entries");
  check_refused(kDevice + "workspace = { scale = 0 }\n", "scale is 0");
  check_refused(kDevice + "workspace = { scale = 101 }\n", "scale is 101");
  check_refused(kDevice + "workspace = { scale = -1 }\n", "scale is -1");
  check_refused(kDevice + "workspace = { force_scale = 0 }\n", "force_scale is 0");
  check_refused(kDevice + "workspace = { force_scale = nan }\n", "force_scale is nan");
  check_refused(kDevice + "workspace = { size = 1 }\n", "not a known key");
  check_refused(kDevice + "buttons = { grab = 32 }\n", "grab is 32");
  check_refused(kDevice + "buttons = { clutch = -2 }\n", "clutch is -2");
  check_refused(kDevice + "buttons = { reset = 1.5 }\n", "not a whole number");
  check_refused(kDevice + "buttons = { grab = 1 }\n", "clutch is 1, which another function has");
  check_refused(kDevice + "buttons = { fire = 1 }\n", "not a known key");
}

TEST_CASE("bridge configuration: torque at the device, and a hand that feels it") {
  const BridgeConfig config =
      ConfigFile(
          "[bridge]\nmax_torque = 0.4\ncontinuous_torque = 0.1\nmax_torque_rate = 20\n" + kDevice +
          "hand = { inertia = 1e-4, angular_stiffness = 0.5 }\nmotors = { max_torque = 0.2 }\n" +
          kDevice + "hand = {}\n")
          .load();
  CHECK(config.max_torque == 0.4);
  CHECK(config.continuous_torque == 0.1);
  CHECK(config.max_torque_rate == 20.0);
  REQUIRE(config.devices.at(0).hand->turn);
  CHECK(config.devices[0].hand->turn->inertia == 1e-4);
  CHECK(config.devices[0].hand->turn->damping == 5e-3);
  CHECK(config.devices[0].hand->turn->stiffness == 0.5);
  CHECK(config.devices[0].motors.max_torque == 0.2);
  CHECK_FALSE(config.devices.at(1).hand->turn);
  check_refused("[bridge]\nmax_torque = -0.1\n" + kDevice, "max_torque is -0.1");
  check_refused("[bridge]\nmax_torque = 11\n" + kDevice, "max_torque is 11");
  check_refused("[bridge]\ncontinuous_torque = 0\n" + kDevice, "continuous_torque is 0");
  check_refused("[bridge]\nmax_torque_rate = 0.5\n" + kDevice, "max_torque_rate is 0.5");
  check_refused(kDevice + "hand = { inertia = 0 }\n", "inertia is 0");
  check_refused(kDevice + "hand = { angular_damping = 0.01 }\n", "needs an inertia");
  check_refused(kDevice + "motors = { max_torque = 0 }\n", "max_torque is 0");
}

TEST_CASE("bridge configuration takes every key") {
  const BridgeConfig config =
      ConfigFile(
          "[bridge]\nserver = \"[::1]:4000\"\nrate = 500\nmax_force = 2\ncontinuous_force = "
          "1\nstream = \"udp\"\nconnect_timeout = 0.05\nkey_file = \"/k/irdm.key\"\n"
          "[[device]]\ntype = \"virtual\"\nscript = \"/a.csv\"\nhand = { mass = 0.2 }\n"
          "[[device]]\ntype = \"openhaptics\"\n")
          .load();
  REQUIRE(config.server);
  CHECK(config.server->host == "::1");
  CHECK(config.server->port == 4000);
  CHECK(config.rate == 500.0);
  CHECK(config.max_force == 2.0);
  CHECK(config.continuous_force == 1.0);
  CHECK(config.connect_timeout == 0.05);
  CHECK(config.udp);
  CHECK(config.key_file == "/k/irdm.key");
  REQUIRE(config.devices.size() == 2);
  CHECK(config.devices[0].script == "/a.csv");
  REQUIRE(config.devices[0].hand);
  CHECK(config.devices[0].hand->mass == 0.2);
  CHECK(config.devices[0].hand->damping == 2.0);
  CHECK(config.devices[0].hand->stiffness == 300.0);
  CHECK(config.devices[1].type == "openhaptics");
}

TEST_CASE("bridge configuration takes a simulated link") {
  CHECK_FALSE(ConfigFile("[[device]]\nscript = \"/a.csv\"\n").load().link);
  const BridgeConfig config =
      ConfigFile(
          "[bridge.link]\ndelay = 0.01\njitter = 0.002\nloss = 0.1\nbandwidth = 2e7\nseed = 5\n"
          "bridge_overruns = { every = 2, longest = 0.02, pause_at = 3, pause = 0.5 "
          "}\n[[device]]\nscript = \"/a.csv\"\n")
          .load();
  REQUIRE(config.link);
  CHECK(config.link->channel.delay == 0.01);
  CHECK(config.link->channel.jitter == 0.002);
  CHECK(config.link->channel.loss == 0.1);
  CHECK(config.link->channel.bandwidth == 2e7);
  CHECK(config.link->seed == 5);
  CHECK(config.link->bridge_overruns.pause_at == 3.0);
  CHECK(config.link->bridge_overruns.pause == 0.5);
  CHECK(config.link->bridge_overruns.every == 2.0);
  CHECK(config.link->bridge_overruns.longest == 0.02);
  CHECK(config.link->server_overruns.every == 0.0);
}

TEST_CASE("the command line names server, device and script") {
  const BridgeConfig config = ConfigFile("[[device]]\ntype = \"openhaptics\"\n")
                                  .load({.server = "h:1", .device = "virtual", .script = "b.csv"});
  CHECK(config.server->host == "h");
  CHECK(config.server->port == 1);
  CHECK(config.devices[0].type == "virtual");
  CHECK(config.devices[0].script == "b.csv");
}

TEST_CASE("a stylus is armed by itself or by a button, and the command line decides") {
  const auto by_button = [](const std::string& text, const std::string& option = "") {
    return ConfigFile(text + kDevice).load({.arm = option}).arm_by_button;
  };
  CHECK_FALSE(by_button(""));
  CHECK_FALSE(by_button("[bridge]\narm = \"automatic\"\n"));
  CHECK(by_button("[bridge]\narm = \"button\"\n"));
  CHECK(by_button("[bridge]\narm = \"automatic\"\n", "button"));
  CHECK_FALSE(by_button("[bridge]\narm = \"button\"\n", "automatic"));
  check_refused("[bridge]\narm = \"never\"\n" + kDevice, "arm is 'never'");
}

TEST_CASE("bridge configuration refuses what does not fit") {
  check_refused("", "no device");
  check_refused("device = 3", "not a list of tables");
  check_refused("[[device]]\n", "has no script");
  check_refused(kDevice + "[extra]\n", "not a known key");
  check_refused(kDevice + "speed = 1\n", "speed is not a known key");
  check_refused("[bridge]\nx = 1\n" + kDevice, "bridge.x is not a known key");
  check_refused("[[device]]\ntype = \"magic\"\n", "type is 'magic'");
  check_refused("[bridge.link]\nloss = 1\n" + kDevice, "loss is 1");
  check_refused("[bridge.link]\ndelay = -1\n" + kDevice, "delay is -1");
  check_refused("[bridge.link]\nserver_overruns = { often = 1 }\n" + kDevice,
                "often is not a known key");
  check_refused(kDevice + "hand = 3\n", "not a table");
  check_refused(kDevice + "hand = { mass = 0 }\n", "mass is 0");
  check_refused(kDevice + "hand = { mass = nan }\n", "mass is nan");
  check_refused(kDevice + "hand = { damping = -1 }\n", "damping is -1");
  check_refused(kDevice + "hand = { stiffness = 0 }\n", "stiffness is 0");
  check_refused(kDevice + "hand = { colour = 1 }\n", "not a known key");
  check_refused("[bridge]\nrate = 10\n" + kDevice, "rate is 10");
  check_refused("[bridge]\nmax_force = 0\n" + kDevice, "max_force is 0");
  check_refused("[bridge]\nmax_force = 41\n" + kDevice, "max_force is 41");
  check_refused("[bridge]\ncontinuous_force = 0\n" + kDevice, "continuous_force is 0");
  check_refused("[bridge]\nstream = \"both\"\n" + kDevice, "stream");
  check_refused("[bridge]\nconnect_timeout = 0\n" + kDevice, "connect_timeout is 0");
  check_refused("[bridge]\nconnect_timeout = 0.2\n" + kDevice, "connect_timeout is 0.2");
  check_refused("[bridge]\nserver = \"here\"\n" + kDevice, "'here' has no port");
  check_refused(kDevice, "given here and by --script", {.script = "b.csv"});
  check_refused("[[device]]\n[[device]]\n", "several devices", {.script = "b.csv"});
  CHECK_THROWS_AS(load_bridge_config("/nowhere/bridge.toml"), Error);
}

TEST_CASE("a server address needs a host and a port in range") {
  CHECK(parse_server_address("localhost:65535", "x").port == 65535);
  for (const char* bad :
       {"", ":", "host", "host:", ":1", "host:0", "host:65536", "host:1x", "host:-1", "::1:80"}) {
    CHECK_THROWS_AS(parse_server_address(bad, "x"), Error);
  }
}

TEST_CASE("bridge configuration takes sensor and motors of a virtual device, perfect by default") {
  const DeviceConfig plain = ConfigFile(kDevice).load().devices.at(0);
  CHECK(plain.sensor.resolution == 0.0);
  CHECK(plain.sensor.noise == 0.0);
  CHECK(plain.motors.max_force == MotorParameters::kNone);
  CHECK(plain.motors.continuous_force == MotorParameters::kNone);
  CHECK(plain.motors.watchdog == MotorParameters::kNone);
  const DeviceConfig real =
      ConfigFile(kDevice +
                 "sensor = { resolution = 5.5e-5, noise = 1e-5, seed = 7 }\nmotors = { max_force = "
                 "3.3, continuous_force = 0.88, time_constant = 30, watchdog = 0.032 }\n")
          .load()
          .devices.at(0);
  CHECK(real.sensor.resolution == 5.5e-5);
  CHECK(real.sensor.noise == 1e-5);
  CHECK(real.sensor.seed == 7);
  CHECK(real.motors.max_force == 3.3);
  CHECK(real.motors.continuous_force == 0.88);
  CHECK(real.motors.time_constant == 30.0);
  CHECK(real.motors.watchdog == 0.032);
  check_refused(kDevice + "sensor = { resolution = 0.02 }\n", "resolution is 0.02");
  check_refused(kDevice + "sensor = { noise = -1 }\n", "noise is -1");
  check_refused(kDevice + "sensor = { seed = -1 }\n", "seed is -1");
  check_refused(kDevice + "sensor = { colour = 1 }\n", "not a known key");
  check_refused(kDevice + "motors = { max_force = 0 }\n", "max_force is 0");
  check_refused(kDevice + "motors = { continuous_force = 101 }\n", "continuous_force is 101");
  check_refused(kDevice + "motors = { time_constant = 0 }\n", "time_constant is 0");
  check_refused(kDevice + "motors = { watchdog = 0 }\n", "watchdog is 0");
  check_refused(kDevice + "motors = { colour = 1 }\n", "not a known key");
}

TEST_CASE("devices of a driver have names of their own") {
  const std::string touch = "[[device]]\ntype = \"openhaptics\"\n";
  const BridgeConfig config =
      ConfigFile(touch + "name = \"Left\"\n" + touch + "name = \"Right\"\n").load();
  CHECK(config.devices.at(0).name == "Left");
  CHECK(config.devices.at(1).name == "Right");
  CHECK(ConfigFile(touch).load().devices.at(0).name.empty());
  check_refused(touch + touch, "two devices of type openhaptics with the name ''");
  check_refused(touch + "name = 3\n", "name is not text");
  CHECK_NOTHROW(ConfigFile(kDevice + kDevice).load());
}

TEST_CASE("a device of an unknown type is refused") {
  CHECK_THROWS_AS(make_device({.type = "magic"}), Error);
}

TEST_CASE("every bridge configuration of the project loads, with its scripts") {
  int found = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(IRDM_SOURCE_DIR "/configs/bridges")) {
    if (entry.path().extension() != ".toml") continue;
    INFO(entry.path());
    ++found;
    for (const DeviceConfig& device : load_bridge_config(entry.path()).devices) {
      if (device.type == "virtual") CHECK(make_device(device)->duration() > 0.0);
    }
  }
  CHECK(found > 0);
}
