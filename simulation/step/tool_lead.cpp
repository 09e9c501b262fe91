#include "simulation/step/tool_lead.hpp"

#include <algorithm>
#include <string>

namespace irdm {
namespace {

// A quaternion this short says nothing.
constexpr double kLeastNorm = 1e-6;

bool leads(const StylusCommand& command) noexcept {
  return command.present && command.tip.allFinite() && command.orientation.coeffs().allFinite() &&
         command.orientation.norm() > kLeastNorm;
}

}  // namespace

ToolLead::ToolLead(const ToolCoupling& tool, const SimulationObject& object,
                   const std::string& where)
    : object_(tool.object),
      dt_(object.model->dt),
      coupling_(object.model->body, -object.model->mesh.com_offset, tool.constants, dt_, where),
      start_orientation_(object.orientation.normalized()) {
  start_position_ = object.position + start_orientation_ * coupling_.reference();
  reset();
}

void ToolLead::reset() noexcept {
  position_ = start_position_;
  orientation_ = start_orientation_;
  home_ = {position_, orientation_};
  arrived_ = false;
  share_ = 0.0;
}

void ToolLead::begin(const StylusCommand& command) noexcept {
  if (!leads(command)) {
    home_ = {position_, orientation_};
    arrived_ = false;
    share_ = 0.0;
    return;
  }
  const Quaternion wanted = (command.orientation.normalized() * start_orientation_).normalized();
  if (arrived_) {
    share_ = std::min(1.0, share_ + dt_ / kRamp);
    move_to(command.tip, wanted);
    return;
  }
  const Vector3 way = command.tip - position_;
  const Vector3 turn = rotation_vector(wanted * orientation_.conjugate());
  const double steps =
      std::max(way.norm() / (kApproach * dt_), turn.norm() / (kAngularApproach * dt_));
  arrived_ = steps <= 1.0;
  if (arrived_) {
    move_to(command.tip, wanted);
  } else {
    move_to(position_ + way / steps, rotation_from_vector(turn / steps) * orientation_);
  }
}

void ToolLead::move_to(const Vector3& position, const Quaternion& orientation) noexcept {
  const Vector3 way = position - position_;
  const Vector3 turn = rotation_vector(orientation * orientation_.conjugate());
  home_.position = position_ + 0.5 * way;
  home_.orientation = (rotation_from_vector(0.5 * turn) * orientation_).normalized();
  home_.velocity = way / dt_;
  home_.angular_velocity = turn / dt_;
  position_ = position;
  orientation_ = orientation.normalized();
}

}  // namespace irdm
