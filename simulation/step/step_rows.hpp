#pragma once

#include <array>
#include <cstdint>

#include "simulation/step/step_record.hpp"

namespace irdm {

// What a step did to styluses and objects as plain numbers, so that it can be handed to other
// languages as it is. Quaternions are w, x, y, z.

/// One stylus in one step, as in StylusRecord.
struct StylusRow {
  std::int32_t present = 0;
  std::int32_t contact = 0;  ///< ContactState
  std::int32_t object = -1;
  std::int32_t tool = -1;
  std::array<double, 3> tip{};     ///< [m], W
  std::array<double, 3> proxy{};   ///< [m], W
  std::array<double, 3> force{};   ///< on the stylus [N], W
  std::array<double, 3> torque{};  ///< on the stylus about the tip [N m], W
};

/// One object at the end of one step, as in ObjectStep.
struct ObjectRow {
  std::int32_t asleep = 0;
  std::int32_t solved = 1;
  std::array<double, 3> position{};          ///< of the centre of mass [m], W
  std::array<double, 4> orientation{};       ///< B to W
  std::array<double, 3> velocity{};          ///< [m/s], W
  std::array<double, 3> angular_velocity{};  ///< [rad/s], W
  double residual = 0.0;                     ///< of the contact problem [m]
};

StylusRow row_of(const StylusRecord& stylus) noexcept;
ObjectRow row_of(const ObjectStep& object) noexcept;

}  // namespace irdm
