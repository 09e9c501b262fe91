#include "simulation/step/step_rows.hpp"

#include <limits>
#include <utility>

namespace irdm {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

ContactRow::Numbers numbers(const Vector3& v) noexcept {
  return {v.x(), v.y(), v.z()};
}

// The most that a step can have.
std::size_t most(const SimulationConfig& config) {
  const std::size_t on_floor = config.floor ? kMaxFloorContacts : 0;
  const std::size_t between = touches_bodies(config) ? 2 * kMaxBodyContacts : 0;
  return config.objects.size() * (config.styluses.size() + on_floor) + between +
         config.styluses.size();
}

ContactRow begin(std::size_t object, ContactKind kind, std::size_t other) noexcept {
  ContactRow out;
  out.object = static_cast<std::int32_t>(object);
  out.kind = static_cast<std::int32_t>(kind);
  out.other = static_cast<std::int32_t>(other);
  out.state = static_cast<std::int32_t>(ContactState::kTouching);
  out.normal = out.slip = {kUnknown, kUnknown, kUnknown};
  out.area = kUnknown;
  return out;
}

}  // namespace

StylusRow row_of(const StylusRecord& stylus) noexcept {
  return {stylus.present ? 1 : 0, static_cast<std::int32_t>(stylus.contact),
          stylus.object,          stylus.tool,
          numbers(stylus.tip),    numbers(stylus.proxy),
          numbers(stylus.force),  numbers(stylus.torque)};
}

ObjectRow row_of(const ObjectStep& object, double energy) noexcept {
  const Quaternion& q = object.orientation;
  return {object.asleep ? 1 : 0,    object.solved ? 1 : 0,
          numbers(object.position), {q.w(), q.x(), q.y(), q.z()},
          numbers(object.velocity), numbers(object.angular_velocity),
          object.residual,          energy};
}

ContactRows::ContactRows(const SimulationConfig& config)
    : floor_(config.floor), scenery_count_(config.scenery.size()) {
  forces_.reserve(most(config));
}

std::span<const ContactRow> ContactRows::of(const Simulation& simulation,
                                            const StepRecord& record) noexcept {
  forces_.clear();
  add_styluses(simulation, record);
  if (floor_) add_floor(simulation, record);
  add_bodies(record);
  return forces_;
}

void ContactRows::add_styluses(const Simulation& simulation, const StepRecord& record) noexcept {
  for (std::size_t s = 0; s < static_cast<std::size_t>(record.stylus_count); ++s) {
    const StylusRecord& stylus = record.stylus[s];
    if (stylus.tool >= 0) {
      const auto led = static_cast<std::size_t>(stylus.tool);
      ContactRow out = begin(led, ContactKind::kCoupling, s);
      out.position = numbers(stylus.proxy);
      out.force = numbers(simulation.object(stylus.tool).coupling().force);
      forces_.push_back(out);
      continue;
    }
    for (std::size_t i = 0; i < static_cast<std::size_t>(record.object_count); ++i) {
      const ContactRecord& contact = record.object[i].contact[s];
      if (contact.state == ContactState::kFree) continue;
      const Quaternion& halfway = record.object[i].halfway;
      ContactRow out = begin(i, ContactKind::kStylus, s);
      out.state = static_cast<std::int32_t>(contact.state);
      out.slipping = contact.slipping ? 1 : 0;
      out.position = numbers(contact.proxy + halfway * contact.offset);
      out.normal = numbers(-(halfway * contact.normal));
      out.force = numbers(halfway * contact.force);
      forces_.push_back(out);
    }
  }
}

void ContactRows::add_floor(const Simulation& simulation, const StepRecord& record) noexcept {
  for (std::size_t i = 0; i < static_cast<std::size_t>(record.object_count); ++i) {
    const ObjectRecord& object = record.object[i];
    const ModelMesh& mesh = simulation.object(static_cast<int>(i)).model().mesh;
    for (std::size_t k = 0; k < static_cast<std::size_t>(object.floor_count); ++k) {
      const FloorForce& floor = object.floor[k];
      ContactRow out = begin(i, ContactKind::kFloor, 0);
      out.place = floor.node;
      const Vector3 x = object.position + object.orientation * mesh.rest_position(floor.node);
      out.position = numbers(x - (floor_->normal.dot(x) - floor_->height) * floor_->normal);
      out.normal = numbers(floor_->normal);
      out.force = numbers(object.halfway * floor.force.cast<double>());
      forces_.push_back(out);
    }
  }
}

void ContactRows::add_bodies(const StepRecord& record) noexcept {
  for (const BodyContactRecord& contact : record.body_contacts()) {
    const bool scenery = contact.other < 0;
    auto other = static_cast<std::size_t>(scenery ? -1 - contact.other : contact.other);
    ContactKind kind = scenery ? ContactKind::kScenery : ContactKind::kObject;
    if (scenery && other >= scenery_count_) {
      kind = ContactKind::kStylus;
      other -= scenery_count_;
    }
    ContactRow out = begin(static_cast<std::size_t>(contact.object), kind, other);
    out.place = contact.sample;
    out.slipping = contact.slipping ? 1 : 0;
    out.position = numbers(contact.position);
    out.normal = numbers(contact.normal);
    out.force = numbers(contact.force);
    out.slip = numbers(contact.slip);
    out.area = contact.area;
    forces_.push_back(out);
    if (scenery) continue;
    std::swap(out.object, out.other);
    for (auto* vector : {&out.normal, &out.force, &out.slip}) {
      for (double& component : *vector) component = -component;
    }
    forces_.push_back(out);
  }
}

}  // namespace irdm
