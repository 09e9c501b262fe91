#include "server/threads/viewer_stylus.hpp"

#include <cmath>

namespace irdm {
namespace {

Vector3 no_longer_than(const Vector3& v, double length) noexcept {
  const double norm = v.norm();
  return norm > length ? Vector3(length / norm * v) : v;
}

}  // namespace

StylusCommand ViewerStylus::next(const StylusCommand& wanted, const StylusRecord& last) noexcept {
  StylusCommand command = wanted;
  if (!wanted.present || !wanted.tip.allFinite()) {
    present_ = false;
    command.present = false;
    return command;
  }
  if (!present_) tip_ = wanted.tip;
  present_ = true;
  const double share = 1.0 - std::exp(-dt_ / kSmoothing);
  Vector3 tip = tip_ + no_longer_than(share * (wanted.tip - tip_), kFastest * dt_);
  if (last.contact != ContactState::kFree && stiffness_ > 0 && max_force_ > 0) {
    // Where the spring would be without tension.
    const Vector3 rest = last.tip + last.force / stiffness_;
    tip = rest + no_longer_than(tip - rest, max_force_ / stiffness_);
  }
  command.tip = tip_ = tip;
  return command;
}

}  // namespace irdm
