#include "common/wire/bytes.hpp"
#include "common/wire/payload.hpp"
#include "common/wire/protocol_error.hpp"
#include "device_bridge/contact/bridge_contact.hpp"
#include "tests/fuzz/harness.hpp"

namespace irdm::fuzz {

// What has passed the checks is solved for a hand that goes through the place and back.
void contact_model(Input input) {
  if (input.size() < wire::kContactModelSize) return;
  ContactModel model;
  try {
    wire::ByteReader in(input.first(wire::kContactModelSize));
    model = wire::decode_contact_model(in).model;
  } catch (const wire::ProtocolError&) {
    return;
  }
  const ContactModelFault fault = check(model);
  expect(*word(fault) != '\0', "a fault has a name");
  if (fault != ContactModelFault::kNone) return;
  BridgeContact contact(model.valid ? model.dt : 0.002, 1'000'000);
  const Vector3 place = model.motion.position + model.motion.orientation * model.place;
  const Vector3 way =
      model.valid ? Vector3(model.motion.orientation * model.normal) : Vector3::UnitY();
  std::int64_t now_ns = 0;
  for (int k = 0; k < 40; ++k, now_ns += 1'000'000) {
    if (k % 8 == 0) {
      contact.receive(model, now_ns);
      ++model.step;
    }
    const double height = 0.02 - 0.002 * (k < 20 ? k : 40 - k);
    contact.tick(now_ns, place + height * way);
    expect(contact.wanted().force.allFinite(),
           "a contact model that is believed gives finite forces");
  }
}

}  // namespace irdm::fuzz
