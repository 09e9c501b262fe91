#include "server/network/stylus_slots.hpp"

#include <algorithm>

namespace irdm {

StylusSlots::StylusSlots(int count)
    : ports_(static_cast<std::size_t>(count)), owners_(static_cast<std::size_t>(count)) {}

std::optional<int> StylusSlots::claim(int count, bool predicts) {
  const auto first =
      std::search_n(owners_.begin(), owners_.end(), count, false,
                    [](const Owner& owner, bool wanted) { return owner.claimed == wanted; });
  if (first == owners_.end()) return std::nullopt;
  std::for_each(first, first + count, [&](Owner& owner) {
    owner = Owner{.claimed = true, .predicts = predicts, .session = ++sessions_};
    owner.applied = AppliedHistory(owner.session);
  });
  return static_cast<int>(first - owners_.begin());
}

void StylusSlots::release(int first, int count, bool in_order) {
  for (int slot = first; slot < first + count; ++slot) {
    make_absent(slot, in_order);
    port(slot).link.put({});
    port(slot).applied.put(AppliedHistory());
    owners_[static_cast<std::size_t>(slot)] = Owner{};
  }
}

bool StylusSlots::put(int slot, const StylusSample& sample, std::int64_t now_ns) {
  Owner& owner = owners_[static_cast<std::size_t>(slot)];
  if (owner.any_sample && sample.sequence <= owner.newest_sequence) return false;
  if (!owner.any_sample) owner.first_time_ns = sample.time_ns;
  owner.any_sample = true;
  owner.present = true;
  owner.newest_sequence = sample.sequence;
  owner.arrived_ns = now_ns;
  port(slot).in.put(
      {.present = true, .sample = sample, .predicts = owner.predicts, .session = owner.session});
  return true;
}

void StylusSlots::put(int slot, const AppliedForces& applied) {
  Owner& owner = owners_[static_cast<std::size_t>(slot)];
  owner.applied.take(applied);
  port(slot).applied.put(owner.applied);
}

const ContactModel* StylusSlots::take_model(int slot) {
  TripleBuffer<OfSession<ContactModel>>& box = port(slot).model;
  const Owner& owner = owners_[static_cast<std::size_t>(slot)];
  const bool usable = box.receive() && owner.predicts && box.front().session == owner.session;
  return usable ? &box.front().value : nullptr;
}

void StylusSlots::expire(std::int64_t now_ns, std::int64_t limit_ns) {
  for (int slot = 0; slot < count(); ++slot) {
    if (now_ns - owners_[static_cast<std::size_t>(slot)].arrived_ns > limit_ns) make_absent(slot);
  }
}

void StylusSlots::make_absent(int slot, bool in_order) {
  Owner& owner = owners_[static_cast<std::size_t>(slot)];
  if (!owner.present) return;
  owner.present = false;
  port(slot).in.put({.left = in_order});
}

std::optional<StylusForce> StylusSlots::take_force(int slot) {
  if (!port(slot).out.receive()) return std::nullopt;
  const Owner& owner = owners_[static_cast<std::size_t>(slot)];
  const StylusForce& force = port(slot).out.front();
  // A force for an owner that has gone may still be on its way when the next one comes.
  const bool ours = owner.any_sample && force.sample_sequence <= owner.newest_sequence &&
                    force.sample_time_ns >= owner.first_time_ns;
  return ours ? std::optional(force) : std::nullopt;
}

}  // namespace irdm
