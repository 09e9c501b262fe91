#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "simulation/step/simulation_config.hpp"
#include "simulation/step/step_record.hpp"
#include "trace/recording.hpp"
#include "trace/trace_layout.hpp"

/// The sets of a trace file (docs/files.md), read whole and checked: against the scene and its
/// models, and for numbers that no run has. All of these throw Error.
namespace irdm::trace {

/// What a stylus did to an object.
struct ContactRows {
  std::vector<std::uint8_t> state;
  std::vector<std::uint8_t> slipping;
  std::vector<std::int32_t> nodes;
  std::vector<double> weights;
  std::vector<double> force;  ///< on the object, B; or on the stylus, W, when the object is alone
  std::vector<double> proxy;
  std::vector<double> offset;
  std::vector<double> arm_shift;

  /// A row with arms longer than lab::kPlace counts as one without a contact. Throws Error, also
  /// for a node that the model does not have.
  ContactRows(const hdf5::File& file, const RowReader& reader, const TraceCheck& check,
              const std::string& path, int node_count);

 private:
  void leave_out_implausible();
};

/// Of one stylus, of each step.
struct StylusRows {
  std::vector<double> tip, proxy, force;
  std::vector<std::uint8_t> present;
  std::vector<std::int32_t> buttons, object;
  std::vector<double> orientation = {}, torque = {};  ///< of one that leads a tool
};

/// What the floor did to an object.
struct FloorRows {
  std::vector<std::int32_t> node;
  std::vector<float> force;
  std::vector<std::size_t> first;  ///< of each step, and one more
};

/// Of one object, of each step.
struct ObjectRows {
  std::vector<double> position, orientation, velocity, angular_velocity;
  std::vector<ContactRows> contacts;  ///< per stylus
  FloorRows floor;
};

/// Settings, and the steps from which on they were in force.
struct SettingsRows {
  std::vector<std::uint64_t> force_step;
  std::vector<Settings> settings;
};

/// Forces that bridges told too late, by the step that took them in.
struct LateRows {
  std::vector<std::uint64_t> force_step;
  std::vector<LateForce> late;
  // Of the object, before the step, with all of them.
  std::vector<double> position, orientation, velocity, angular_momentum;
};

/// What bridges that solve contacts told, by the step that it was for.
struct BridgedRows {
  std::vector<std::uint64_t> force_step;
  std::vector<std::int32_t> stylus;
  std::vector<BridgedForce> bridged;
};

/// Throw Error; a trace of a scene without a floor has no rows of it.
/// @param last_step that counts
FloorRows read_floor(const hdf5::File& file, const RowReader& reader, const TraceCheck& check,
                     const std::string& path, int node_count);
SettingsRows read_settings(const hdf5::File& file, const SimulationConfig& config,
                           std::uint64_t last_step);
LateRows read_late(const hdf5::File& file, const SimulationConfig& config, std::uint64_t last_step);
BridgedRows read_bridged(const hdf5::File& file, const SimulationConfig& config,
                         std::uint64_t last_step);

}  // namespace irdm::trace
