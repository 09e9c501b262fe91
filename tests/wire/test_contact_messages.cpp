#include <bit>
#include <limits>
#include <span>
#include <vector>

#include "common/wire/frame.hpp"
#include "common/wire/payload.hpp"
#include "common/wire/protocol_error.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;
using namespace irdm::wire;

// Every offset below is that of docs/protocol.md.

namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
constexpr double kEndless = std::numeric_limits<double>::infinity();

/// Payload alone, in a frame that is whole otherwise.
Bytes payload_of(const Message& message) {
  const FrameBytes frame = encode_frame(message, 1, 0, 2);
  return {frame.view().begin() + kHeaderSize, frame.view().end()};
}

template <typename T>
T read_back(const Bytes& payload) {
  FrameBytes frame = encode_frame(Message(T{}), 1, 0, 2);
  std::copy(payload.begin(), payload.end(), frame.storage.begin() + kHeaderSize);
  const std::span<std::uint8_t> all(frame.storage.data(), frame.size);
  ByteWriter(all.subspan(32, 4)).put(crc32c(all.first(32), all.subspan(kHeaderSize)));
  FrameReader reader;
  std::span<const std::uint8_t> rest(all);
  return std::get<T>(reader.read(rest).value().message);
}

template <typename T>
ProtocolFault fault_of(const Bytes& payload) {
  try {
    read_back<T>(payload);
  } catch (const ProtocolError& error) {
    return error.fault();
  }
  FAIL("nothing was refused");
  return {};
}

double number_at(const Bytes& payload, std::size_t at) {
  return ByteReader(std::span(payload).subspan(at, 8)).get_number();
}

template <typename T>
Bytes with(Bytes payload, std::size_t at, T value) {
  ByteWriter(std::span(payload).subspan(at, sizeof(T))).put(value);
  return payload;
}

/// Numbers that are all different: the fields in the order of the document count up from 1.
ContactModelMessage numbered() {
  double next = 0.0;
  const auto vector = [&] {
    next += 3.0;
    return Vector3(next - 2.0, next - 1.0, next);
  };
  const auto quaternion = [&] {
    next += 4.0;
    return Quaternion(next - 3.0, next - 2.0, next - 1.0, next);
  };
  const auto symmetric = [&] {
    next += 6.0;
    Matrix3 m;
    m << next - 5, next - 2, next - 1, next - 2, next - 4, next, next - 1, next, next - 3;
    return m;
  };
  ContactModelMessage message{.stylus = 3};
  ContactModel& model = message.model;
  model.valid = true;
  model.state = ContactState::kTouching;
  model.horizon = kMaxHorizon;
  model.step = 0x0102030405060708;
  model.missing = 0x1112131415161718;
  model.newest = 0x2122232425262728;
  model.dt = 0.002;
  model.energy = ++next;
  model.body.mass = ++next;
  model.body.inertia = symmetric();
  model.motion.position = vector();
  model.motion.orientation = quaternion();
  model.motion.velocity = vector();
  model.motion.angular_momentum = vector();
  model.free_forces.gravity = vector();
  model.free_forces.damping = {next + 1, next + 2};
  model.free_forces.tether = {next + 3, next + 4};
  next += 4;
  model.free_forces.home_position = vector();
  model.free_forces.home_orientation = quaternion();
  model.other_force = vector();
  model.other_torque = vector();
  model.place = vector();
  model.normal = vector();
  model.friction = {next + 1, next + 2};
  next += 2;
  model.series = symmetric();
  for (std::size_t n = 0; n < kMaxHorizon; ++n) {
    model.path[n] = vector();
    model.response[n] = symmetric();
  }
  return message;
}

AppliedForcesMessage forces(int count) {
  AppliedForcesMessage message{.stylus = 2};
  message.applied.step = 100;
  message.applied.base = 95;
  message.applied.count = count;
  for (int i = 0; i < count; ++i) {
    message.applied.past[static_cast<std::size_t>(i)] = {Vector3(i, 2, 3), Vector3(4, 5, i),
                                                         Vector3(6, i, 7)};
  }
  return message;
}

}  // namespace

TEST_CASE("a contact model has its documented fields, in their order") {
  const Bytes payload = payload_of(numbered());
  REQUIRE(payload.size() == 4080);
  const Bytes head{3, 0, 1, 0, 1, 0, 50, 0, 8, 7, 6, 5, 4, 3, 2, 1};
  CHECK(std::equal(head.begin(), head.end(), payload.begin()));
  CHECK(payload[16] == 0x18);
  CHECK(payload[24] == 0x28);
  CHECK(number_at(payload, 32) == 0.002);
  for (std::size_t i = 0; i < (4080 - 40) / 8; ++i) {
    CHECK(number_at(payload, 40 + 8 * i) == static_cast<double>(i + 1));
  }
  CHECK(payload_of(read_back<ContactModelMessage>(payload)) == payload);
}

TEST_CASE("a contact model's flags and horizon come back, and what is beyond them is zero") {
  ContactModelMessage message = numbered();
  message.model.slipping = true;
  message.model.body.support = Support::kFixed;
  message.model.horizon = 7;
  const Bytes payload = payload_of(message);
  CHECK(number_at(payload, 480 + 72 * 7) == 0.0);
  const ContactModel back = read_back<ContactModelMessage>(payload).model;
  CHECK(back.slipping);
  CHECK_FALSE(back.paused);
  CHECK(back.body.support == Support::kFixed);
  CHECK(back.horizon == 7);
  CHECK(back.path[6] == message.model.path[6]);
  CHECK(back.response[6] == message.model.response[6]);
  message.model.valid = false;
  message.model.paused = true;
  message.model.step = 9;
  message.model.newest = kNoStep;
  const ContactModel none = read_back<ContactModelMessage>(payload_of(message)).model;
  CHECK_FALSE(none.valid);
  CHECK(none.paused);
  CHECK(none.step == 9);
  CHECK(none.newest == kNoStep);
}

TEST_CASE("a contact model is refused for each number that is not finite, and for bad heads") {
  using M = ContactModelMessage;
  const Bytes good = payload_of(numbered());
  for (std::size_t at = 32; at < good.size(); at += 8) {
    const bool friction = at == 416 || at == 424;
    if (friction) continue;
    CHECK(fault_of<M>(with(good, at, kNoNumber)) == ProtocolFault::kNotFinite);
    CHECK(fault_of<M>(with(good, at, kEndless)) == ProtocolFault::kNotFinite);
  }
  CHECK(read_back<M>(with(good, 416, kEndless)).model.friction.static_ == kEndless);
  CHECK(fault_of<M>(with(good, 2, std::uint16_t{0x11})) == ProtocolFault::kBadValue);
  CHECK(fault_of<M>(with(good, 4, std::uint16_t{3})) == ProtocolFault::kBadValue);
  CHECK(fault_of<M>(with(good, 6, std::uint16_t{51})) == ProtocolFault::kBadValue);
  CHECK(fault_of<M>(with(good, 6, std::uint16_t{0})) == ProtocolFault::kBadValue);
  CHECK(fault_of<M>(with(good, 2, std::uint16_t{0})) == ProtocolFault::kBadValue);
}

TEST_CASE("applied forces have their documented fields, and those that are there come back") {
  const Bytes payload = payload_of(forces(3));
  REQUIRE(payload.size() == 1176);
  const Bytes head{2, 0, 3, 0, 0, 0, 0, 0, 100, 0, 0, 0, 0, 0, 0, 0};
  CHECK(std::equal(head.begin(), head.end(), payload.begin()));
  CHECK(number_at(payload, 24 + 72 * 2) == 2.0);
  CHECK(number_at(payload, 24 + 72 * 2 + 24) == 4.0);
  CHECK(number_at(payload, 24 + 72 * 2 + 48) == 6.0);
  CHECK(number_at(payload, 24 + 72 * 3) == 0.0);
  const AppliedForces back = read_back<AppliedForcesMessage>(payload).applied;
  CHECK(back.count == 3);
  CHECK(back.step == 100);
  CHECK(back.base == 95);
  CHECK(back.past[2].tip == Vector3(4, 5, 2));
  CHECK(back.past[2].arm == Vector3(6, 2, 7));
}

TEST_CASE("applied forces are refused that are none, too many, of no step, too large or too far") {
  using M = AppliedForcesMessage;
  const Bytes good = payload_of(forces(16));
  CHECK(fault_of<M>(with(good, 2, std::uint16_t{0})) == ProtocolFault::kBadValue);
  CHECK(fault_of<M>(with(good, 2, std::uint16_t{17})) == ProtocolFault::kBadValue);
  CHECK(fault_of<M>(with(good, 8, std::uint64_t{14})) == ProtocolFault::kBadValue);
  CHECK(read_back<M>(with(good, 8, std::uint64_t{15})).applied.step == 15);
  CHECK(fault_of<M>(with(good, 8, ~std::uint64_t{0})) == ProtocolFault::kBadValue);
  for (std::size_t at = 24; at < good.size(); at += 8) {
    CHECK(fault_of<M>(with(good, at, kNoNumber)) == ProtocolFault::kNotFinite);
    CHECK(fault_of<M>(with(good, at, -1000.1)) == ProtocolFault::kBadValue);
  }
}
