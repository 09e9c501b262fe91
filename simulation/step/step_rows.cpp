#include "simulation/step/step_rows.hpp"

namespace irdm {
namespace {

std::array<double, 3> numbers(const Vector3& v) noexcept {
  return {v.x(), v.y(), v.z()};
}

}  // namespace

StylusRow row_of(const StylusRecord& stylus) noexcept {
  return {stylus.present ? 1 : 0, static_cast<std::int32_t>(stylus.contact),
          stylus.object,          stylus.tool,
          numbers(stylus.tip),    numbers(stylus.proxy),
          numbers(stylus.force),  numbers(stylus.torque)};
}

ObjectRow row_of(const ObjectStep& object) noexcept {
  const Quaternion& q = object.orientation;
  return {object.asleep ? 1 : 0,    object.solved ? 1 : 0,
          numbers(object.position), {q.w(), q.x(), q.y(), q.z()},
          numbers(object.velocity), numbers(object.angular_velocity),
          object.residual};
}

}  // namespace irdm
