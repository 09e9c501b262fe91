#include "replay/rerun/deviation.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "common/error.hpp"

namespace irdm::replay {
namespace {

bool is_finite(const ObjectRecord& object) {
  bool finite = object.position.allFinite() && object.orientation.coeffs().allFinite() &&
                object.velocity.allFinite() && object.angular_velocity.allFinite() &&
                object.floor_force.allFinite();
  for (const ContactRecord& contact : object.contact) {
    finite = finite && (contact.state == ContactState::kFree ||
                        (contact.force.allFinite() && contact.proxy.allFinite()));
  }
  return finite;
}

[[noreturn]] void refuse(const std::string& trace) {
  throw Error(trace, "gives numbers that are not finite when it is rerun",
              "it is damaged, or the model is not that of the recording: record it again");
}

bool is_finite(const BodyContactRecord& contact) {
  return contact.force.allFinite() && contact.position.allFinite() && contact.normal.allFinite() &&
         contact.slip.allFinite();
}

}  // namespace

bool is_finite(const StepRecord& record) {
  bool finite = true;
  for (const BodyContactRecord& contact : record.body_contacts()) {
    finite = finite && is_finite(contact);
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(record.object_count); ++i) {
    finite = finite && is_finite(record.object[i]);
  }
  for (std::size_t s = 0; s < static_cast<std::size_t>(record.stylus_count); ++s) {
    const StylusRecord& stylus = record.stylus[s];
    finite = finite && stylus.tip.allFinite() && stylus.proxy.allFinite() &&
             stylus.force.allFinite() && stylus.orientation.coeffs().allFinite() &&
             stylus.torque.allFinite();
  }
  return finite;
}

void require_finite(const StepRecord& again, const std::string& trace) {
  if (!is_finite(again)) refuse(trace);
}

void require_finite(const std::vector<Points>& displacements, const std::string& trace) {
  const auto finite = [](const Points& u) { return u.allFinite(); };
  if (!std::ranges::all_of(displacements, finite)) refuse(trace);
}

double angle_between(const Quaternion& a, const Quaternion& b) noexcept {
  const Quaternion apart = a.conjugate() * b;
  return 2.0 * std::atan2(apart.vec().norm(), std::abs(apart.w()));
}

void Deviation::add(const StepRecord& recorded, const StepRecord& again) {
  const auto grow = [](double& largest, double value) {
    largest =
        std::isnan(value) ? std::numeric_limits<double>::infinity() : std::max(largest, value);
  };
  for (std::size_t i = 0; i < static_cast<std::size_t>(recorded.object_count); ++i) {
    const ObjectRecord& a = recorded.object[i];
    const ObjectRecord& b = again.object[i];
    grow(position_, (a.position - b.position).norm());
    grow(orientation_, angle_between(a.orientation, b.orientation));
    grow(velocity_, (a.velocity - b.velocity).norm());
    grow(angular_velocity_, (a.angular_velocity - b.angular_velocity).norm());
  }
  bool same = true;
  for (std::size_t s = 0; s < static_cast<std::size_t>(recorded.stylus_count); ++s) {
    grow(force_, (recorded.stylus[s].force - again.stylus[s].force).norm());
    grow(peak_force_, recorded.stylus[s].force.norm());
    same = same && recorded.stylus[s].contact == again.stylus[s].contact;
  }
  if (same) return;
  if (other_contacts_++ == 0) first_other_ = recorded.time;
}

std::string Deviation::text() const {
  char lines[512];
  std::snprintf(lines, sizeof lines,
                "largest difference to the trace: force %.3g N (peak %.3g N), position %.3g m, "
                "orientation %.3g rad,\n  velocity %.3g m/s, angular velocity %.3g rad/s\n",
                force_, peak_force_, position_, orientation_, velocity_, angular_velocity_);
  std::string text = lines;
  if (other_contacts_ == 0) return text;
  std::snprintf(lines, sizeof lines, "other contacts in %zu steps, the first at %.6g s\n",
                other_contacts_, first_other_);
  return text + lines;
}

}  // namespace irdm::replay
