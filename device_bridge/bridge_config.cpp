#include "device_bridge/bridge_config.hpp"

#include <array>
#include <charconv>
#include <limits>
#include <set>
#include <utility>

#include "common/blackbox/black_box_file.hpp"
#include "common/error.hpp"
#include "common/number_text.hpp"
#include "device_bridge/device_registry.hpp"

namespace irdm {
std::vector<std::string> device_types() {
  return {"virtual", "openhaptics", "forcedimension", "haply"};
}

std::vector<std::string> arm_words() {
  return {"automatic", "button"};
}

namespace {

HandParameters read_hand(TomlTable table) {
  HandParameters hand;
  hand.mass = table.number("mass", between(1e-3, 100.0), hand.mass);
  hand.damping = table.number("damping", between(0.0, 1e4), hand.damping);
  hand.stiffness = table.number("stiffness", between(1e-3, 1e6), hand.stiffness);
  if (table.has("inertia")) {
    hand.turn.emplace();
    hand.turn->inertia = table.number("inertia", between(1e-7, 10.0));
    hand.turn->damping = table.number("angular_damping", between(0.0, 100.0), hand.turn->damping);
    hand.turn->stiffness =
        table.number("angular_stiffness", between(1e-5, 1e4), hand.turn->stiffness);
  } else {
    for (const char* key : {"angular_damping", "angular_stiffness"}) {
      if (table.has(key)) table.fail(key, "needs an inertia", "give hand.inertia, too");
    }
  }
  table.finish();
  return hand;
}

SensorParameters read_sensor(TomlTable table) {
  constexpr double kCoarsest = 0.01;
  SensorParameters sensor;
  sensor.resolution = table.number("resolution", between(0.0, kCoarsest), sensor.resolution);
  sensor.noise = table.number("noise", between(0.0, kCoarsest), sensor.noise);
  sensor.seed = static_cast<std::uint32_t>(
      table.integer("seed", 0, std::numeric_limits<int>::max(), static_cast<int>(sensor.seed)));
  table.finish();
  return sensor;
}

MotorParameters read_motors(TomlTable table) {
  const Range force{.lowest = 0.0, .highest = 100.0, .lowest_included = false};  // N, N m
  MotorParameters motors;
  if (table.has("max_force")) motors.max_force = table.number("max_force", force);
  if (table.has("continuous_force")) {
    motors.continuous_force = table.number("continuous_force", force);
  }
  if (table.has("max_torque")) motors.max_torque = table.number("max_torque", force);
  motors.time_constant = table.number("time_constant", between(0.01, 1e4), motors.time_constant);
  if (table.has("watchdog")) motors.watchdog = table.number("watchdog", between(0.001, 10.0));
  table.finish();
  return motors;
}

ButtonMap read_buttons(TomlTable table) {
  constexpr int kHighest = 31;
  ButtonMap buttons;
  std::set<int> taken;
  const auto read = [&](const char* key, int& bit) {
    bit = table.integer(key, ButtonMap::kNone, kHighest, bit);
    if (bit != ButtonMap::kNone && !taken.insert(bit).second) {
      table.fail(key, "is " + std::to_string(bit) + ", which another function has",
                 "give each function a bit of its own, or -1 for none");
    }
  };
  read("grab", buttons.grab);
  read("clutch", buttons.clutch);
  read("reset", buttons.reset);
  table.finish();
  return buttons;
}

// Keys of Haply devices alone.
void read_haply(TomlTable& table, const std::string& file, DeviceConfig& device) {
  for (const char* key : {"service", "grip", "shared"}) {
    if (table.has(key) && device.type != "haply") {
      table.fail(key, "is for devices of type haply", "remove it");
    }
  }
  const std::string service = table.text("service", "");
  if (!service.empty()) device.service = parse_server_address(service, file + ": device.service");
  device.grip = table.text("grip", "");
  device.shared = table.boolean("shared", false);
}

DeviceConfig read_device(TomlTable table, const std::string& file,
                         const BridgeOverrides& overrides) {
  DeviceConfig device;
  device.type = table.choice("type", device_types(), device.type);
  if (!overrides.device.empty()) device.type = overrides.device;
  device.name = table.text("name", "");
  device.auto_init = table.boolean("auto_init", false);
  if (device.auto_init && device.type != "forcedimension") {
    table.fail("auto_init", "is for devices of Force Dimension", "remove it");
  }
  read_haply(table, file, device);
  if (table.has("script")) {
    device.script = table.path("script");
    if (!overrides.script.empty()) {
      table.fail("script", "is given here and by --script", "give it once");
    }
  } else if (!overrides.script.empty()) {
    device.script = overrides.script;
  } else if (device.type == "virtual") {
    table.fail("", "has no script", "add script = \"FILE.csv\" or give --script FILE.csv");
  }
  if (table.has("commissioned")) {
    const std::filesystem::path report = table.path("commissioned");
    if (!overrides.commissions) device.commissioned = commission::load_report(report);
  }
  if (table.has("hand")) device.hand = read_hand(table.table("hand"));
  device.sensor = read_sensor(table.table("sensor"));
  device.motors = read_motors(table.table("motors"));
  device.mapping.workspace = read_workspace(table.table("workspace"));
  device.mapping.buttons = read_buttons(table.table("buttons"));
  table.finish();
  return device;
}

Overruns read_overruns(TomlTable table) {
  Overruns overruns;
  overruns.every = table.number("every", between(0.0, 1000.0), overruns.every);
  overruns.longest = table.number("longest", between(0.0, 1.0), overruns.longest);
  overruns.pause_at = table.number("pause_at", between(0.0, 1e6), overruns.pause_at);
  overruns.pause = table.number("pause", between(0.0, 1000.0), overruns.pause);
  table.finish();
  return overruns;
}

SimulatedLink read_link(TomlTable table) {
  SimulatedLink link;
  link.channel.delay = table.number("delay", between(0.0, 1.0), link.channel.delay);
  link.channel.jitter = table.number("jitter", between(0.0, 1.0), link.channel.jitter);
  link.channel.loss = table.number("loss", between(0.0, 0.9), link.channel.loss);
  link.channel.bandwidth = table.number("bandwidth", between(0.0, 1e12), link.channel.bandwidth);
  link.server_overruns = read_overruns(table.table("server_overruns"));
  link.bridge_overruns = read_overruns(table.table("bridge_overruns"));
  link.seed = static_cast<std::uint64_t>(table.integer("seed", 0, 1'000'000'000, 1));
  table.finish();
  return link;
}

void read_bridge(TomlTable table, const std::string& file, const BridgeOverrides& overrides,
                 BridgeConfig& config) {
  const std::string server = table.text("server", "");
  if (!server.empty()) config.server = parse_server_address(server, file + ": bridge.server");
  read_servo_keys(table, config);
  const std::string arm = table.choice("arm", arm_words(), "automatic");
  config.arm_by_button = (overrides.arm.empty() ? arm : overrides.arm) == "button";
  if (table.has("link")) config.link = read_link(table.table("link"));
  config.black_box = read_black_box(table);
  table.finish();
}

// Two devices of a driver have to be told apart.
void check_names(const std::vector<DeviceConfig>& devices, const std::string& file) {
  std::set<std::array<std::string, 3>> seen;
  for (const DeviceConfig& device : devices) {
    const ServerAddress service = device.service.value_or(ServerAddress{});
    const std::string where = address_text(service.host, service.port);
    if (device.type == "virtual" || seen.insert({device.type, where, device.name}).second) continue;
    throw Error(
        file, "has two devices of type " + device.type + " with the name " + in_quotes(device.name),
        "give each its own name, as in the vendor's setup");
  }
}

}  // namespace

void read_servo_keys(TomlTable& table, BridgeConfig& config) {
  const Range force{.lowest = 0.0, .highest = 40.0, .lowest_included = false};
  config.rate = table.number("rate", between(100.0, 4000.0), config.rate);
  config.max_force = table.number("max_force", force, config.max_force);
  config.continuous_force = table.number("continuous_force", force, config.continuous_force);
  config.max_torque = table.number("max_torque", between(0.0, 10.0), config.max_torque);
  config.continuous_torque =
      table.number("continuous_torque", {.lowest = 0.0, .highest = 10.0, .lowest_included = false},
                   config.continuous_torque);
  config.max_torque_rate =
      table.number("max_torque_rate", between(1.0, 1000.0), config.max_torque_rate);
  config.predict = table.choice("mode", {"predict", "hold"}, "predict") == "predict";
  config.udp = table.choice("stream", {"tcp", "udp"}, "tcp") == "udp";
  config.connect_timeout =
      table.number("connect_timeout", between(0.01, 0.1), config.connect_timeout);
  if (table.has("key_file")) config.key_file = table.path("key_file");
  config.realtime =
      scheduling_from_word(table.choice("realtime", {"require", "prefer", "ignore"}, "prefer"));
}

Workspace read_workspace(TomlTable table) {
  constexpr double kFarthest = 100.0;
  const Range factor = between(0.01, 100.0);
  Workspace workspace;
  workspace.position =
      Vector3(table.numbers("position", 3, between(-kFarthest, kFarthest), {0.0, 0.0, 0.0}).data());
  const auto wxyz = table.numbers("rotation", 4, between(-kFarthest, kFarthest), {1, 0, 0, 0});
  const Quaternion rotation(wxyz[0], wxyz[1], wxyz[2], wxyz[3]);
  if (rotation.norm() < 1e-6) {
    table.fail("rotation", "has no length",
               "give a quaternion w, x, y, z, for instance [1, 0, 0, 0]");
  }
  workspace.rotation = rotation.normalized();
  workspace.scale = table.number("scale", factor, workspace.scale);
  workspace.force_scale = table.number("force_scale", factor, workspace.force_scale);
  table.finish();
  return workspace;
}

ServerAddress parse_server_address(const std::string& text, const std::string& where) {
  const std::string remedy = "give HOST:PORT with a port from 1 to 65535";
  const std::size_t colon = text.rfind(':');
  if (text.find("://") != std::string::npos) {
    throw Error(where, in_quotes(text) + " is the address of a page", "give HOST:PORT for bridges");
  }
  if (colon == std::string::npos) throw Error(where, in_quotes(text) + " has no port", remedy);
  ServerAddress address;
  address.host = text.substr(0, colon);
  if (address.host.starts_with('[') && address.host.ends_with(']')) {
    address.host = address.host.substr(1, address.host.size() - 2);
  } else if (address.host.find(':') != std::string::npos) {
    throw Error(where, in_quotes(text) + " is ambiguous",
                "write an IPv6 address as [ADDRESS]:PORT");
  }
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data() + colon + 1, end, address.port);
  if (address.host.empty() || error != std::errc() || stop != end || address.port == 0) {
    throw Error(where, in_quotes(text) + " is not a server", remedy);
  }
  return address;
}

BridgeConfig load_bridge_config(const std::filesystem::path& path,
                                const BridgeOverrides& overrides) {
  return read_bridge_config(TomlTable::parse_file(path), path.string(), overrides);
}

BridgeConfig read_bridge_config(TomlTable root, const std::string& name,
                                const BridgeOverrides& overrides) {
  BridgeConfig config;
  read_bridge(root.table("bridge"), name, overrides, config);
  for (TomlTable& table : root.tables("device")) {
    config.devices.push_back(read_device(std::move(table), name, overrides));
    config.devices.back().realtime = config.realtime;
  }
  root.finish();
  if (config.devices.empty()) {
    throw Error(name, "has no device", "add a [[device]] table");
  }
  check_names(config.devices, name);
  if (!overrides.script.empty() && config.devices.size() > 1) {
    throw Error(name, "has several devices and --script is one script",
                "name each script in its [[device]] table");
  }
  if (!overrides.server.empty()) {
    config.server = parse_server_address(overrides.server, "--server");
  }
  return config;
}

}  // namespace irdm
