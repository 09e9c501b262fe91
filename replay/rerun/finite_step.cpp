#include "replay/rerun/finite_step.hpp"

#include <algorithm>

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
  throw Error(trace, "gives numbers that are not finite when it is made again",
              "it is damaged, or the model is not that of the recording: record it again");
}

}  // namespace

bool is_finite(const StepRecord& record) {
  bool finite = true;
  for (std::size_t i = 0; i < static_cast<std::size_t>(record.object_count); ++i) {
    finite = finite && is_finite(record.object[i]);
  }
  for (std::size_t s = 0; s < static_cast<std::size_t>(record.stylus_count); ++s) {
    const StylusRecord& stylus = record.stylus[s];
    finite =
        finite && stylus.tip.allFinite() && stylus.proxy.allFinite() && stylus.force.allFinite();
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

}  // namespace irdm::replay
