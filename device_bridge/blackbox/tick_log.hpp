#pragma once

#include <cstdint>
#include <map>

#include "common/blackbox/row_log.hpp"
#include "common/geometry.hpp"
#include "common/stylus.hpp"
#include "device_bridge/haptic_device.hpp"
#include "device_bridge/safety/safety_filter.hpp"

namespace irdm {

/// One tick of one stylus: what came in, what was asked for, what the filter made of it.
struct TickRow {
  std::int64_t time_ns = 0;  ///< when the tick began, monotonic_ns()
  int stylus = 0;            ///< of the bridge, from 0
  std::int64_t late_ns = 0;  ///< by how much it began too late
  std::uint64_t missed = 0;  ///< ticks that were left out so far
  // Link
  bool linked = false;
  bool server_ended = false;  ///< the last session ended with the server's goodbye
  std::uint64_t session = 0;  ///< how many were welcomed so far
  // Device
  Vector3 reading = Vector3::Zero();  ///< tip as it was read; not a number: of no use [m], D
  DeviceState device;
  StylusSample sample;
  // Force
  bool predicts = false;         ///< the contact is solved here
  std::uint64_t force_step = 0;  ///< of the newest force of the server
  ForceDemand demand;
  FilterState state = FilterState::kDisarmed;
  FilterCounts counts;
  double success_rate = 0.0;
  double port_energy = 0.0;          ///< see Passivity [J]
  double gain = 1.0;                 ///< see OscillationDetector
  double warmth = 0.0;               ///< of the motors, 0 to 1
  Vector3 force = Vector3::Zero();   ///< that was shown [N], D
  Vector3 torque = Vector3::Zero();  ///< the same [N m], D
};

/// Is told of every tick of the servo loop.
class TickListener {
 public:
  virtual ~TickListener() = default;
  /// Servo thread; real-time safe.
  virtual void put(const TickRow& row) noexcept = 0;
};

/// Every tick of every stylus. Faults are a device that fails or is lost, a latched fault of the
/// safety filter, and a connection that is lost while a force is felt.
class TickLog final : public RowLog<TickRow>, public TickListener {
 public:
  static constexpr std::size_t kCapacity = 4096;  ///< 1 s of four styluses at 1 kHz

  TickLog() : RowLog(kCapacity) {}
  void put(const TickRow& row) noexcept override { RowLog::put(row); }
  void write(hdf5::File& file, std::int64_t origin_ns) const override;

 private:
  std::optional<Fault> look(const TickRow& row) override;

  std::map<int, TickRow> last_;  ///< by stylus
};

}  // namespace irdm
