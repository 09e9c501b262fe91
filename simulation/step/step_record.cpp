#include "simulation/step/step_record.hpp"

#include <algorithm>

namespace irdm {

void copy_object(const ObjectRecord& from, std::size_t styluses, ObjectRecord& to) noexcept {
  static_cast<ObjectStep&>(to) = from;
  std::copy_n(from.contact.begin(), styluses, to.contact.begin());
  std::copy_n(from.floor.begin(), from.floor_count, to.floor.begin());
}

void copy_step(const StepRecord& from, StepRecord& to) noexcept {
  static_cast<StepHead&>(to) = from;
  for (std::size_t i = 0; i < static_cast<std::size_t>(from.object_count); ++i) {
    copy_object(from.object[i], static_cast<std::size_t>(from.stylus_count), to.object[i]);
  }
  std::copy_n(from.stylus.begin(), from.stylus_count, to.stylus.begin());
  to.late.count = from.late.count;
  std::copy_n(from.late.force.begin(), from.late.count, to.late.force.begin());
  to.body_contact = from.body_contact;
}

}  // namespace irdm
