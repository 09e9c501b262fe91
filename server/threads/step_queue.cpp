#include "server/threads/step_queue.hpp"

#include <algorithm>

namespace irdm {
namespace {

bool free(const ContactRecord& contact) noexcept {
  return contact.state == ContactState::kFree && contact.force.isZero(0.0);
}

}  // namespace

StepShape step_shape(const SimulationConfig& config) {
  return {config.objects.size(), config.styluses.size(), config.floor.has_value(),
          touches_bodies(config)};
}

StepQueue::Counts StepQueue::most(const StepShape& shape) noexcept {
  return {.objects = shape.objects,
          .styluses = shape.styluses,
          .contacts = shape.objects * shape.styluses,
          .floor = shape.floor ? shape.objects * kMaxFloorContacts : 0,
          .late = LateForces::kMost,
          .bodies = shape.bodies ? std::size_t{kMaxBodyContacts} : 0};
}

StepQueue::Counts StepQueue::room_for(std::size_t capacity, const StepShape& shape) noexcept {
  const Counts one = most(shape);
  const auto room = [&](std::size_t largest, std::size_t usual) {
    return std::max(largest, capacity * std::min(largest, usual));
  };
  return {.objects = capacity * one.objects,
          .styluses = capacity * one.styluses,
          .contacts = room(one.contacts, 2 * shape.styluses),
          .floor = room(one.floor, 2 * kUsualContacts),
          .late = room(one.late, kUsualLate),
          .bodies = room(one.bodies, kUsualContacts)};
}

StepQueue::StepQueue(std::size_t capacity, const StepShape& shape)
    : StepQueue(most(shape), capacity, room_for(capacity, shape)) {}

StepQueue::StepQueue(const Counts& most, std::size_t capacity, const Counts& room)
    : most_(most),
      heads_(capacity),
      objects_(room.objects),
      styluses_(room.styluses),
      contacts_(room.contacts),
      floor_(room.floor),
      late_(room.late),
      bodies_(room.bodies) {}

StepQueue::Counts StepQueue::count(const StepRecord& record) noexcept {
  Counts counts{.objects = static_cast<std::size_t>(record.object_count),
                .styluses = static_cast<std::size_t>(record.stylus_count),
                .late = record.late.count,
                .bodies = record.body_contacts().size()};
  for (std::size_t i = 0; i < counts.objects; ++i) {
    const ObjectRecord& object = record.object[i];
    counts.floor += static_cast<std::size_t>(object.floor_count);
    for (std::size_t s = 0; s < counts.styluses; ++s) {
      counts.contacts += free(object.contact[s]) ? 0 : 1;
    }
  }
  return counts;
}

bool StepQueue::fits(const Counts& counts) const noexcept {
  return heads_.fits(1) && objects_.fits(counts.objects) && styluses_.fits(counts.styluses) &&
         contacts_.fits(counts.contacts) && floor_.fits(counts.floor) && late_.fits(counts.late) &&
         bodies_.fits(counts.bodies);
}

bool StepQueue::has_room() const noexcept {
  return fits(most_);
}

bool StepQueue::push(const StepRecord& record) noexcept {
  const Counts counts = count(record);
  if (!fits(counts)) return false;
  heads_.write({record, counts.late, counts.contacts, counts.bodies});
  for (std::size_t i = 0; i < counts.objects; ++i) {
    const ObjectRecord& object = record.object[i];
    objects_.write(object);
    for (std::size_t s = 0; s < counts.styluses; ++s) {
      if (!free(object.contact[s])) contacts_.write({i, s, object.contact[s]});
    }
    for (std::size_t c = 0; c < static_cast<std::size_t>(object.floor_count); ++c) {
      floor_.write(object.floor[c]);
    }
  }
  for (std::size_t s = 0; s < counts.styluses; ++s) styluses_.write(record.stylus[s]);
  for (const LateForce& late : record.late.view()) late_.write(late);
  for (const BodyContactRecord& contact : record.body_contacts()) bodies_.write(contact);
  pushed_.fetch_add(1, std::memory_order_release);
  return true;
}

bool StepQueue::pop(StepRecord& record) noexcept {
  if (pushed_.load(std::memory_order_acquire) == popped_) return false;
  ++popped_;
  const Head& head = heads_.read();
  static_cast<StepHead&>(record) = head.step;
  const auto styluses = static_cast<std::size_t>(record.stylus_count);
  for (std::size_t i = 0; i < static_cast<std::size_t>(record.object_count); ++i) {
    ObjectRecord& object = record.object[i];
    static_cast<ObjectStep&>(object) = objects_.read();
    std::fill_n(object.contact.begin(), styluses, ContactRecord{});
    for (std::size_t c = 0; c < static_cast<std::size_t>(object.floor_count); ++c) {
      object.floor[c] = floor_.read();
    }
  }
  for (std::size_t c = 0; c < head.contacts; ++c) {
    const Contact& contact = contacts_.read();
    record.object[contact.object].contact[contact.stylus] = contact.record;
  }
  for (std::size_t s = 0; s < styluses; ++s) record.stylus[s] = styluses_.read();
  record.late.count = head.late;
  for (std::size_t l = 0; l < head.late; ++l) record.late.force[l] = late_.read();
  record.body_contact.clear();
  for (std::size_t c = 0; c < head.bodies; ++c) record.body_contact.push_back(bodies_.read());
  heads_.release();
  objects_.release();
  styluses_.release();
  contacts_.release();
  floor_.release();
  late_.release();
  bodies_.release();
  return true;
}

}  // namespace irdm
