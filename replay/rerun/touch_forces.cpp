#include "replay/rerun/touch_forces.hpp"

namespace irdm::replay {

void find_touch_forces(int number, const ObjectRecord& recorded,
                       std::span<const BodyContactRecord> contacts,
                       std::vector<TouchForce>& forces) {
  forces.clear();
  const Vector3 middle = 0.5 * (recorded.start.position + recorded.position);
  for (const BodyContactRecord& contact : contacts) {
    if (contact.object != number && contact.other != number) continue;
    const bool first = contact.object == number;
    forces.push_back(
        {first ? contact.force : Vector3(-contact.force), contact.position - middle, &contact});
  }
}

}  // namespace irdm::replay
