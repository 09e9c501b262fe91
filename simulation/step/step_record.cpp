#include "simulation/step/step_record.hpp"

#include <algorithm>

namespace irdm {

void copy_step(const StepRecord& from, StepRecord& to) noexcept {
  static_cast<StepHead&>(to) = from;
  for (std::size_t i = 0; i < static_cast<std::size_t>(from.object_count); ++i) {
    const ObjectRecord& object = from.object[i];
    static_cast<ObjectStep&>(to.object[i]) = object;
    std::copy_n(object.contact.begin(), from.stylus_count, to.object[i].contact.begin());
    std::copy_n(object.floor.begin(), object.floor_count, to.object[i].floor.begin());
  }
  std::copy_n(from.stylus.begin(), from.stylus_count, to.stylus.begin());
  to.late.count = from.late.count;
  std::copy_n(from.late.force.begin(), from.late.count, to.late.force.begin());
  to.body_contact = from.body_contact;
}

}  // namespace irdm
