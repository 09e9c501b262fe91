#include "simulation/step/nodal_forces.hpp"

namespace irdm {

RecordedForces::RecordedForces(const RestSurface& surface, const std::vector<double>& radii)
    : forces_(radii.size() * kMaxPatchNodes + kMaxFloorContacts) {
  for (const double radius : radii) masks_.emplace_back(surface, radius);
}

std::span<const NodalForce> RecordedForces::of(const ObjectRecord& record) noexcept {
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
  return forces_.view();
}

std::span<const NodalForce> RecordedForces::of(const LateForce& late) noexcept {
  forces_.clear();
  masks_[static_cast<std::size_t>(late.stylus)].spread(late.point, patch_);
  forces_.add(patch_, late.force);
  return forces_.view();
}

}  // namespace irdm
