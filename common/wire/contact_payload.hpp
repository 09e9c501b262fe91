#pragma once

#include <cstddef>

#include "common/wire/bytes.hpp"
#include "common/wire/message.hpp"

/// The payloads of the contact that is solved at the bridge; as in payload.hpp.
namespace irdm::wire {

inline constexpr std::size_t kContactModelSize = 4072;
inline constexpr std::size_t kAppliedForcesSize = 24 + 72 * AppliedForces::kSteps;

void encode(const ContactModelMessage& message, ByteWriter& out);
ContactModelMessage decode_contact_model(ByteReader& in);
void encode(const AppliedForcesMessage& message, ByteWriter& out);
AppliedForcesMessage decode_applied_forces(ByteReader& in);

}  // namespace irdm::wire
