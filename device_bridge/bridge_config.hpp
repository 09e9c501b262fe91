#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/blackbox/black_box.hpp"
#include "common/config/toml_reader.hpp"
#include "common/realtime/scheduling.hpp"
#include "device_bridge/commission/report.hpp"
#include "device_bridge/link/simulated_link.hpp"
#include "device_bridge/servo_loop.hpp"
#include "device_bridge/virtual_stylus.hpp"

namespace irdm {

/// Where a server listens.
struct ServerAddress {
  std::string host = {};  ///< name or numeric address
  std::uint16_t port = 0;
};

/// Reads HOST:PORT or [IPV6]:PORT. Throws Error; `where` stands for the place it was written in.
ServerAddress parse_server_address(const std::string& text, const std::string& where);

/// One [[device]] table.
struct DeviceConfig {
  std::string type = "virtual";  ///< key `type`: virtual | openhaptics | forcedimension | haply
  std::string name = {};  ///< key `name`: of a real device in its vendor's setup; empty: default
  /// key `service`: of a Haply device, "HOST:PORT"; none: localhost:10001
  std::optional<ServerAddress> service = {};
  std::string grip = {};  ///< key `grip`: id of a Haply device's VerseGrip; empty: the first
  bool shared = false;    ///< key `shared`: another session may command a Haply device, too
  /// as bridge.realtime: of threads that a device has
  RealTimeScheduling realtime = RealTimeScheduling::kPrefer;
  /// key `auto_init`: a device of Force Dimension may move by itself to be initialised
  bool auto_init = false;
  std::filesystem::path script = {};  ///< key `script`: of a virtual device, required there
  std::optional<HandParameters> hand =
      {};  ///< key `hand`, a table; left out: moves exactly as scripted
  // hand.mass [kg], 0.001 to 100, default 0.12
  // hand.damping [N s/m], 0 to 10000, default 2
  // hand.stiffness [N/m], 0.001 to 1e6, default 300
  // hand.inertia [kg m^2], 1e-7 to 10; left out: turned exactly as scripted, and no torque; with it
  // hand.angular_damping [N m s/rad], 0 to 100, default 0.005
  // hand.angular_stiffness [N m/rad], 1e-5 to 1e4, default 0.75
  SensorParameters sensor = {};  ///< key `sensor`, a table, of a virtual device
  // sensor.resolution, sensor.noise [m], 0 to 0.01, default 0; sensor.seed, from 0, default 1
  MotorParameters motors = {};  ///< key `motors`, a table, of a virtual device
  // motors.max_force, motors.continuous_force [N], motors.max_torque [N m], (0, 100], default: no
  // limit
  // motors.time_constant [s], 0.01 to 10000, default 60
  // motors.watchdog [s], 0.001 to 10, default: none
  /// key `commissioned`, a file: of a real device, what commissioning it found, signed off
  std::optional<commission::Report> commissioned = {};
  DeviceMapping mapping = {};  ///< keys `workspace` and `buttons`, tables
  // workspace.position [m], W, each within 100; rotation w x y z, normalised when read
  // workspace.scale, workspace.force_scale, 0.01 to 100
  // buttons.grab, buttons.clutch, buttons.reset: bits 0 to 31, no two the same; -1: none
};

/// The words of `bridge.arm` and --arm.
std::vector<std::string> arm_words();
/// The types that make_device() knows.
std::vector<std::string> device_types();

/// What a bridge's TOML file says.
struct BridgeConfig {
  std::optional<ServerAddress> server;  ///< key `bridge.server`, "HOST:PORT"; no default
  double rate = 1000.0;                 ///< key `bridge.rate`: servo loop [Hz], 100 to 4000
  double max_force = 3.3;               ///< key `bridge.max_force`: shown at most [N], (0, 40]
  double continuous_force = 0.88;       ///< key `bridge.continuous_force`: for long [N], (0, 40]
  /// key `bridge.max_torque`: shown at most, by devices that can [N m], 0 to 10; 0: none
  double max_torque = 0.15;
  double continuous_torque = 0.05;  ///< key `bridge.continuous_torque`: for long [N m], (0, 10]
  /// key `bridge.max_torque_rate`: of one that rises or turns round [N m/s], 1 to 1000; four times
  /// as fast towards zero
  double max_torque_rate = 15.0;
  /// key `bridge.mode`: "predict": the contact is solved here, so that delay is not felt | "hold":
  /// the server's forces are held. In lockstep without a `link` there is no delay, and forces are
  /// held.
  bool predict = true;
  /// table `bridge.link`: a link that is simulated, in lockstep; none: there is none
  std::optional<SimulatedLink> link;
  // link.delay, link.jitter [s], 0 to 1; link.loss, 0 to 0.9; link.seed, from 0, default 1
  // link.server_overruns, link.bridge_overruns: tables, every [s], 0 to 1000; longest [s], 0 to 1
  /// key `bridge.stream`: "tcp" | "udp"; how samples, forces and contact models go. Where UDP does
  /// not get through, by TCP.
  bool udp = false;
  /// key `bridge.arm`: "automatic" | "button": no force before a person has pressed a button of the
  /// stylus
  bool arm_by_button = false;
  double connect_timeout = 0.075;  ///< key `bridge.connect_timeout`: an attempt [s], 0.01 to 0.1
  /// key `bridge.key_file`: the server's key; none: the server is on this machine
  std::optional<std::filesystem::path> key_file;
  /// key `bridge.realtime`: "require" | "prefer" | "ignore"; scheduling of the servo loop
  RealTimeScheduling realtime = RealTimeScheduling::kPrefer;
  /// keys `bridge.black_box`, a folder, "" for none, and `bridge.black_box_files`, 1 to 1000
  BlackBoxSettings black_box = {};
  std::vector<DeviceConfig> devices;  ///< [[device]], one or more, one a stylus
};

/// What the command line says beside the file.
struct BridgeOverrides {
  std::string server = {};   ///< takes the place of bridge.server; empty: not given
  std::string device = {};   ///< takes the place of every device's type; empty: not given
  std::string arm = {};      ///< takes the place of bridge.arm; empty: not given
  std::string script = {};   ///< of the only device, whose table has none; empty: not given
  bool commissions = false;  ///< a report is made: none is read
};

/// Reads and checks a whole configuration. Throws Error with file and line.
/// @param name of the file, for messages
BridgeConfig read_bridge_config(TomlTable root, const std::string& name,
                                const BridgeOverrides& overrides = {});
/// Reads the keys of [bridge] that say how a servo loop runs and connects: all but `server`, `arm`,
/// `link` and those of the black box. Throws Error.
void read_servo_keys(TomlTable& table, BridgeConfig& config);
/// Reads a table `workspace`. Throws Error.
Workspace read_workspace(TomlTable table);
BridgeConfig load_bridge_config(const std::filesystem::path& path,
                                const BridgeOverrides& overrides = {});

}  // namespace irdm
