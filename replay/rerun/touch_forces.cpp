#include "replay/rerun/touch_forces.hpp"

namespace irdm::replay {

void find_touch_forces(int number, const ObjectRecord& recorded,
                       std::span<const BodyContactRecord> contacts,
                       std::vector<TouchForce>& forces) {
  forces.clear();
  const Vector3 middle = 0.5 * (recorded.start.position + recorded.position);
  for (const BodyContactRecord& contact : contacts) {
    for (const bool first : {true, false}) {
      if ((first ? contact.object : contact.other) != number) continue;
      forces.push_back({first ? contact.force : Vector3(-contact.force), contact.position - middle,
                        &contact, first});
    }
  }
}

}  // namespace irdm::replay
