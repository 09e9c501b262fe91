#include "device_bridge/safety/passivity.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/motion/rigid_body.hpp"
#include "device_bridge/safety/time_since.hpp"

namespace irdm {

void WorldWork::observe(std::int64_t now_ns, const Vector3& tip,
                        const Quaternion& orientation) noexcept {
  poses_[count_ % kKept] = {now_ns, tip, orientation};
  ++count_;
}

double WorldWork::answer(std::int64_t time_ns, const Wrench& wrench) noexcept {
  const Pose* pose = at(time_ns);
  if (pose == nullptr || (any_ && time_ns <= answered_.time_ns)) return 0.0;
  const Pose before = std::exchange(answered_, *pose);
  const bool follows = std::exchange(any_, true) &&
                       time_since(before.time_ns, pose->time_ns) <= std::uint64_t{kLongest};
  if (!follows) return 0.0;
  // As the step has it: the force is the one at its end.
  const double given =
      work(wrench, {pose->tip - before.tip,
                    rotation_vector(pose->orientation * before.orientation.conjugate())});
  if (!std::isfinite(given)) return 0.0;
  taken_ -= given;
  const double beyond = std::max(0.0, -taken_);
  taken_ = std::clamp(taken_, 0.0, kMost);
  return beyond;
}

// The newest that is not later; null where that is forgotten.
const WorldWork::Pose* WorldWork::at(std::int64_t time_ns) const noexcept {
  for (std::size_t back = 1; back <= std::min(count_, kKept); ++back) {
    const Pose& pose = poses_[(count_ - back) % kKept];
    if (pose.time_ns <= time_ns) return &pose;
  }
  return nullptr;
}

void Passivity::observe(const Twist& displacement, const Wrench& shown) noexcept {
  before_ = last_;
  last_ = displacement.linear;
  const double given = work(shown, displacement);
  if (!std::isfinite(given)) return;
  energy_ = std::clamp(energy_ - given, limits_.least, limits_.most);
}

void Passivity::forgive(double elapsed) noexcept {
  if (energy_ < 0.0) energy_ = std::min(0.0, energy_ + limits_.forgiven * elapsed);
}

double Passivity::damping(const Wrench& wrench, const Twist& velocity, double tick) const noexcept {
  const double lacking = work(wrench, velocity) * tick - energy();
  const double per_damping =
      (velocity.linear.squaredNorm() + kLever * kLever * velocity.angular.squaredNorm()) * tick;
  if (!(lacking > 0.0)) return 0.0;
  if (!(lacking < limits_.damping * per_damping)) return limits_.damping;
  return lacking / per_damping;
}

void Passivity::grant(double energy) noexcept {
  energy_ = std::min(limits_.most, energy_ + energy);
}

void Passivity::bound(double energy) noexcept {
  bound_ = std::isnan(energy) ? limits_.most : std::clamp(energy, limits_.least, limits_.most);
}

Vector3 Passivity::withheld(const Vector3& force) const noexcept {
  const Vector3 way = 2.0 * last_ - before_;
  const double left = std::max(0.0, energy() + limits_.credit);
  const double excess = force.dot(way) - 0.5 * left;
  const double length = way.stableNorm();
  return share() * (excess > 0.0 ? Vector3(force - excess / length * (way / length)) : force);
}

}  // namespace irdm
