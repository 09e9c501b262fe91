#include "simulation/step/nodal_forces.hpp"

#include "simulation/step/object_sampling.hpp"
#include "simulation/step/stylus_patch.hpp"

namespace irdm {

void NodalSums::clear() noexcept {
  for (const int node : nodes_) {
    sums_[static_cast<std::size_t>(node)].setZero();
    used_[static_cast<std::size_t>(node)] = false;
  }
  nodes_.clear();
}

void NodalSums::add(const SurfacePatch& patch, const Vector3& force) noexcept {
  for (std::size_t i = 0; i < patch.nodes.size(); ++i) {
    const auto node = static_cast<std::size_t>(patch.nodes[i]);
    if (!used_[node]) nodes_.push_back(patch.nodes[i]);
    used_[node] = true;
    sums_[node] += patch.weights[i] * force;
  }
}

void NodalSums::add_to(NodalForces& forces) const noexcept {
  for (const int node : nodes_) forces.add(node, sums_[static_cast<std::size_t>(node)]);
}

void add_body_contact(const BodyContactRecord& contact, bool first, const ContactSampling& sampling,
                      const Quaternion& halfway, NodalSums& sums) noexcept {
  const Vector3 force = halfway.conjugate() * contact.force;
  if (first) {
    sums.add(sampling.patch_of(contact.sample), force);
    return;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    if (contact.weights[i] == 0.0) continue;
    sums.add(sampling.patch(sampling.sites(contact.triangle)[i]), -contact.weights[i] * force);
  }
}

RecordedForces::RecordedForces(const SimulationConfig& config, std::size_t number,
                               const RestSurface& surface)
    : number_(static_cast<int>(number)),
      forces_(config.styluses.size() * kMaxPatchNodes + kMaxFloorContacts +
              static_cast<std::size_t>(surface.node_count())),
      sums_(surface.node_count()) {
  for (const SimulationStylus& stylus : config.styluses) {
    masks_.emplace_back(surface, patch_radius(stylus, surface));
  }
  if (!touches_bodies(config)) return;
  sampling_ = make_sampling(config, *config.objects[number].model, surface);
}

std::span<const NodalForce> RecordedForces::of(
    const ObjectRecord& record, std::span<const BodyContactRecord> contacts) noexcept {
  forces_.clear();
  for (std::size_t s = 0; s < masks_.size(); ++s) {
    const ContactRecord& contact = record.contact[s];
    if (contact.state == ContactState::kFree) continue;
    masks_[s].spread(contact.point, patch_);
    forces_.add(patch_, contact.force);
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(record.floor_count); ++i) {
    forces_.add(record.floor[i].node, record.floor[i].force.cast<double>());
  }
  sums_.clear();
  for (const BodyContactRecord& contact : contacts) {
    for (const bool first : {true, false}) {
      if ((first ? contact.object : contact.other) != number_) continue;
      add_body_contact(contact, first, *sampling_, record.halfway, sums_);
    }
  }
  sums_.add_to(forces_);
  return forces_.view();
}

std::span<const NodalForce> RecordedForces::of(const LateForce& late) noexcept {
  forces_.clear();
  masks_[static_cast<std::size_t>(late.stylus)].spread(late.point, patch_);
  forces_.add(patch_, late.force);
  return forces_.view();
}

}  // namespace irdm
