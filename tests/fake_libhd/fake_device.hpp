#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace fake_hd {

using Force = std::array<double, 3>;
using Transform = std::array<double, 16>;

/// Where a hand moves the stylus at a tick.
struct MotionRow {
  double tick;
  std::array<double, 3> position;  ///< [mm]
  int buttons;
};

/// What a frame was, for the log.
struct FrameRecord {
  unsigned long tick;
  std::array<double, 3> position;  ///< [mm]
  Force force;                     ///< that was asked for [N]
  Force torque;                    ///< the same [mN m]
  bool failed;                     ///< the device had an error in it
  std::int64_t begun_ns;           ///< steady clock
};

/// What happens to a device that has shown a force for some frames.
struct ContactEvent {
  unsigned long after_frames = 0;  ///< with a force; 0: nothing happens
  unsigned long every_frames = 0;  ///< from one event to the next
  std::string what;                ///< "unplug", "hang", "tell", or an error's number; by commas
};

/// One device of the fake driver: a stylus in a hand that nothing disturbs, and its motors.
struct FakeDevice {
  std::string name;
  Transform transform{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  int buttons = 0;
  std::vector<MotionRow> motion;  ///< repeated for ever; empty: it stays where it is put

  double max_force = 3.3;          ///< [N]
  double continuous_force = 0.88;  ///< [N]
  double max_torque = 0.0;         ///< [mN m]; 0: three actuated axes, no torque
  double continuous_torque = 0.0;  ///< [mN m]
  double heating_ticks = std::numeric_limits<double>::infinity();  ///< time constant
  double temperature = 0.0;
  bool tells_temperature = true;
  unsigned calibration = 0x5000;
  int calibration_styles = 2 | 4;
  unsigned updated_style = 0;
  bool calibration_fails = false;
  double calibration_moves = 0.0;  ///< the tip, along x [mm]
  unsigned long calibration_checks = 0;

  bool open = false;
  bool plugged = true;
  bool in_frame = false;
  bool force_output = false;
  bool clamping = false;
  std::vector<unsigned> limits_on;  ///< capabilities that were enabled
  std::vector<unsigned> at_begin;   ///< errors of the next frame's begin
  std::vector<unsigned> at_end;     ///< and of its end
  Force commanded{};                ///< in this frame, then the last one [N]
  Force commanded_torque{};         ///< the same [mN m]
  Force shown{};                    ///< by the motors [N]
  unsigned long frames = 0;
  unsigned long frames_this_tick = 0;
  unsigned long contact_frames = 0;
  ContactEvent event;
  std::vector<FrameRecord> log;

  void move_to(unsigned long tick);
  /// The motors take the force of this frame; returns the errors that come of it.
  std::vector<unsigned> show();
  std::array<double, 3> position() const { return {transform[12], transform[13], transform[14]}; }
};

double magnitude(const Force& force);

}  // namespace fake_hd
