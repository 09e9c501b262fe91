#include "device_bridge/safety/passivity.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace irdm {

void WorldWork::observe(std::int64_t now_ns, const Vector3& tip) noexcept {
  tips_[count_ % kKept] = {now_ns, tip};
  ++count_;
}

double WorldWork::answer(std::int64_t time_ns, const Vector3& force) noexcept {
  const Tip* tip = at(time_ns);
  if (tip == nullptr || (any_ && time_ns <= answered_.time_ns)) return 0.0;
  const Tip before = std::exchange(answered_, *tip);
  const bool follows = std::exchange(any_, true) && tip->time_ns - before.time_ns <= kLongest;
  if (!follows) return 0.0;
  // As the step has it: the force is the one at its end.
  const double given = force.dot(tip->place - before.place);
  if (!std::isfinite(given)) return 0.0;
  taken_ -= given;
  const double beyond = std::max(0.0, -taken_);
  taken_ = std::clamp(taken_, 0.0, kMost);
  return beyond;
}

// The newest that is not later; null where that is forgotten.
const WorldWork::Tip* WorldWork::at(std::int64_t time_ns) const noexcept {
  for (std::size_t back = 1; back <= std::min(count_, kKept); ++back) {
    const Tip& tip = tips_[(count_ - back) % kKept];
    if (tip.time_ns <= time_ns) return &tip;
  }
  return nullptr;
}

void Passivity::observe(const Vector3& displacement, const Vector3& force) noexcept {
  before_ = last_;
  last_ = displacement;
  const double work = force.dot(displacement);
  if (!std::isfinite(work)) return;
  energy_ = std::clamp(energy_ - work, limits_.least, limits_.most);
}

void Passivity::forgive(double elapsed) noexcept {
  if (energy_ < 0.0) energy_ = std::min(0.0, energy_ + limits_.forgiven * elapsed);
}

double Passivity::damping(const Vector3& force, const Vector3& velocity,
                          double tick) const noexcept {
  const double lacking = force.dot(velocity) * tick - energy();
  const double per_damping = velocity.squaredNorm() * tick;
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
