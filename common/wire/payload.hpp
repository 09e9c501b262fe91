#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "common/wire/bytes.hpp"
#include "common/wire/message.hpp"

/// Payloads, field by field as in the tables of docs/protocol.md.
namespace irdm::wire {

/// The largest payload that this version writes.
inline constexpr std::size_t kLargestPayload = 4080;

MessageType type_of(const Message& message) noexcept;
/// The size of a type's payload, of a Force without torque; nothing for a type that this version
/// does not know.
std::optional<std::size_t> payload_size(MessageType type) noexcept;
/// A Force that carries the torque.
inline constexpr std::size_t kForceWithTorqueSize = 104;
std::size_t payload_size(const Message& message) noexcept;

/// Fills `payload`, which has the message's size.
void encode_payload(const Message& message, std::span<std::uint8_t> payload);
/// Reads a payload of the right size. Throws ProtocolError for values outside their range.
Message decode_payload(MessageType type, std::span<const std::uint8_t> payload);

// Of the contact that is solved at the bridge (contact_payload.cpp).

inline constexpr std::size_t kContactModelSize = 4080;
inline constexpr std::size_t kAppliedForcesSize = 24 + 72 * AppliedForces::kSteps;

void encode(const ContactModelMessage& message, ByteWriter& out);
ContactModelMessage decode_contact_model(ByteReader& in);
void encode(const AppliedForcesMessage& message, ByteWriter& out);
AppliedForcesMessage decode_applied_forces(ByteReader& in);

}  // namespace irdm::wire
