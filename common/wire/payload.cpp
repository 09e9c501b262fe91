#include "common/wire/payload.hpp"

#include <array>
#include <cmath>
#include <string>

#include "common/wire/bytes.hpp"
#include "common/wire/protocol_error.hpp"

namespace irdm::wire {
namespace {

constexpr double kNormTolerance = 1e-3;

[[noreturn]] void bad_value(const std::string& what) {
  throw ProtocolError(ProtocolFault::kBadValue, what);
}

bool get_flag(ByteReader& in, const char* name) {
  const auto value = in.get<std::uint8_t>();
  if (value > 1) bad_value(std::string(name) + " is " + std::to_string(value));
  return value == 1;
}

template <typename E>
E get_enum(ByteReader& in, std::uint16_t lowest, std::uint16_t highest, const char* name) {
  const auto value = in.get<std::uint16_t>();
  if (value < lowest || value > highest) {
    bad_value(std::string(name) + " is " + std::to_string(value));
  }
  return static_cast<E>(value);
}

void check_finite(bool finite, const char* name) {
  if (!finite) throw ProtocolError(ProtocolFault::kNotFinite, std::string(name) + " is not finite");
}

void encode(const Hello& hello, ByteWriter& out) {
  out.put(hello.version_min);
  out.put(hello.version_max);
  out.put(hello.capabilities);
  out.put(hello.styluses);
  out.put(static_cast<std::uint8_t>(hello.lockstep));
  out.put_zeros(1);
  out.put_text(hello.name, kNameSize);
}

Hello decode_hello(ByteReader& in) {
  Hello hello;
  hello.version_min = in.get<std::uint16_t>();
  hello.version_max = in.get<std::uint16_t>();
  if (hello.version_min > hello.version_max) bad_value("the version range is empty");
  hello.capabilities = in.get<std::uint32_t>();
  hello.styluses = in.get<std::uint16_t>();
  if (hello.styluses == 0) bad_value("no stylus is asked for");
  hello.lockstep = get_flag(in, "lockstep");
  in.skip(1);
  hello.name = in.get_text(kNameSize);
  return hello;
}

void encode(const Welcome& welcome, ByteWriter& out) {
  out.put(welcome.version);
  out.put(welcome.first_stylus);
  out.put(welcome.capabilities);
  out.put(welcome.session);
  out.put(static_cast<std::uint8_t>(welcome.lockstep));
  out.put_zeros(3);
  out.put(welcome.dt);
}

Welcome decode_welcome(ByteReader& in) {
  Welcome welcome;
  welcome.version = in.get<std::uint16_t>();
  welcome.first_stylus = in.get<std::uint16_t>();
  welcome.capabilities = in.get<std::uint32_t>();
  welcome.session = in.get<std::uint32_t>();
  if (welcome.session == 0) bad_value("the session is 0");
  welcome.lockstep = get_flag(in, "lockstep");
  in.skip(3);
  welcome.dt = in.get_number();
  check_finite(std::isfinite(welcome.dt), "dt");
  if (welcome.dt <= 0.0 || welcome.dt > kLongestStep) bad_value("dt is out of range");
  return welcome;
}

void encode(const Refuse& refuse, ByteWriter& out) {
  out.put(static_cast<std::uint16_t>(refuse.reason));
  out.put(refuse.version_min);
  out.put(refuse.version_max);
  out.put_zeros(2);
  out.put_text(refuse.text, kTextSize);
}

Refuse decode_refuse(ByteReader& in) {
  Refuse refuse;
  refuse.reason = get_enum<RefuseReason>(in, 1, 6, "the reason of a refusal");
  refuse.version_min = in.get<std::uint16_t>();
  refuse.version_max = in.get<std::uint16_t>();
  in.skip(2);
  refuse.text = in.get_text(kTextSize);
  return refuse;
}

void encode(const Goodbye& goodbye, ByteWriter& out) {
  out.put(static_cast<std::uint16_t>(goodbye.reason));
  out.put_zeros(2);
}

Goodbye decode_goodbye(ByteReader& in) {
  Goodbye goodbye;
  goodbye.reason = get_enum<GoodbyeReason>(in, 0, 3, "the reason of a goodbye");
  return goodbye;
}

void encode(const SampleMessage& message, ByteWriter& out) {
  out.put(message.stylus);
  out.put_zeros(2);
  out.put(message.sample.buttons);
  out.put(message.sample.sequence);
  out.put(message.sample.time_ns);
  out.put(message.sample.tip);
  out.put(message.sample.orientation);
}

SampleMessage decode_sample(ByteReader& in) {
  SampleMessage message;
  message.stylus = in.get<std::uint16_t>();
  in.skip(2);
  message.sample.buttons = in.get<std::uint32_t>();
  message.sample.sequence = in.get<std::uint64_t>();
  message.sample.time_ns = in.get_signed();
  message.sample.tip = in.get_vector();
  message.sample.orientation = in.get_quaternion();
  check_finite(message.sample.tip.allFinite(), "the tip");
  check_finite(message.sample.orientation.coeffs().allFinite(), "the orientation");
  if (message.sample.tip.cwiseAbs().maxCoeff() > kMaxCoordinate) bad_value("the tip is too far");
  if (std::abs(message.sample.orientation.norm() - 1.0) > kNormTolerance) {
    bad_value("the orientation is not of norm 1");
  }
  return message;
}

void encode(const ForceMessage& message, ByteWriter& out) {
  out.put(message.stylus);
  out.put(static_cast<std::uint8_t>(message.force.contact));
  out.put_zeros(5);
  out.put(message.force.force_step);
  out.put(message.force.sample_sequence);
  out.put(message.force.sample_time_ns);
  out.put(message.force.force);
  out.put(message.force.proxy);
  if (message.with_torque) out.put(message.force.torque);
}

ForceMessage decode_force(ByteReader& in, bool with_torque) {
  ForceMessage message;
  message.with_torque = with_torque;
  message.stylus = in.get<std::uint16_t>();
  const auto contact = in.get<std::uint8_t>();
  if (contact > 2) bad_value("the contact state is " + std::to_string(contact));
  message.force.contact = static_cast<ContactState>(contact);
  in.skip(5);
  message.force.force_step = in.get<std::uint64_t>();
  message.force.sample_sequence = in.get<std::uint64_t>();
  message.force.sample_time_ns = in.get_signed();
  message.force.force = in.get_vector();
  message.force.proxy = in.get_vector();
  if (with_torque) message.force.torque = in.get_vector();
  check_finite(message.force.force.allFinite(), "the force");
  check_finite(message.force.proxy.allFinite(), "the proxy");
  check_finite(message.force.torque.allFinite(), "the torque");
  return message;
}

void encode(const Quantiles& quantiles, ByteWriter& out) {
  for (const float value : {quantiles.median, quantiles.p99, quantiles.maximum}) out.put(value);
}

Quantiles decode_quantiles(ByteReader& in, const char* name) {
  Quantiles quantiles;
  for (float* value : {&quantiles.median, &quantiles.p99, &quantiles.maximum}) {
    *value = in.get_single();
    check_finite(std::isfinite(*value), name);
    if (*value < 0.0F) bad_value(std::string(name) + " is below 0");
  }
  return quantiles;
}

void encode(const Report& report, ByteWriter& out) {
  out.put(report.stylus);
  out.put_zeros(6);
  encode(report.round_trip, out);
  encode(report.age, out);
}

Report decode_report(ByteReader& in) {
  Report report;
  report.stylus = in.get<std::uint16_t>();
  in.skip(6);
  report.round_trip = decode_quantiles(in, "a round trip");
  report.age = decode_quantiles(in, "an age");
  return report;
}

void encode(const Status& status, ByteWriter& out) {
  for (const std::uint64_t count :
       {status.steps, status.missed, status.unsolved, status.overflows}) {
    out.put(count);
  }
  encode(status.step_time, out);
  encode(status.wakeup_delay, out);
  out.put(status.surface_rate);
  out.put_zeros(4);
}

Status decode_status(ByteReader& in) {
  Status status;
  for (std::uint64_t* count :
       {&status.steps, &status.missed, &status.unsolved, &status.overflows}) {
    *count = in.get<std::uint64_t>();
  }
  status.step_time = decode_quantiles(in, "a step time");
  status.wakeup_delay = decode_quantiles(in, "a wake-up delay");
  status.surface_rate = in.get_single();
  check_finite(std::isfinite(status.surface_rate), "the surface rate");
  if (status.surface_rate < 0.0F) bad_value("the surface rate is below 0");
  return status;
}

void encode(const Datagrams& datagrams, ByteWriter& out) {
  out.put(datagrams.port);
  out.put_zeros(6);
  for (const std::uint8_t byte : datagrams.random) out.put(byte);
}

Datagrams decode_datagrams(ByteReader& in) {
  Datagrams datagrams;
  datagrams.port = in.get<std::uint16_t>();
  if (datagrams.port == 0) bad_value("the port for datagrams is 0");
  in.skip(6);
  for (std::uint8_t& byte : datagrams.random) byte = in.get<std::uint8_t>();
  return datagrams;
}

}  // namespace

MessageType type_of(const Message& message) noexcept {
  // In the order of the variant's alternatives.
  constexpr std::array kTypes{
      MessageType::kHello,   MessageType::kWelcome,      MessageType::kRefuse,
      MessageType::kGoodbye, MessageType::kSample,       MessageType::kForce,
      MessageType::kReport,  MessageType::kContactModel, MessageType::kAppliedForces,
      MessageType::kStatus,  MessageType::kDatagrams};
  static_assert(kTypes.size() == std::variant_size_v<Message>);
  return kTypes[message.index()];
}

std::optional<std::size_t> payload_size(MessageType type) noexcept {
  switch (type) {
    case MessageType::kHello:
      return 12 + kNameSize;
    case MessageType::kWelcome:
      return 24;
    case MessageType::kRefuse:
      return 8 + kTextSize;
    case MessageType::kGoodbye:
      return 4;
    case MessageType::kSample:
      return 80;
    case MessageType::kForce:
      return 80;
    case MessageType::kReport:
      return 32;
    case MessageType::kContactModel:
      return kContactModelSize;
    case MessageType::kAppliedForces:
      return kAppliedForcesSize;
    case MessageType::kStatus:
      return 64;
    case MessageType::kDatagrams:
      return 40;
  }
  return std::nullopt;
}

std::size_t payload_size(const Message& message) noexcept {
  const auto* force = std::get_if<ForceMessage>(&message);
  if (force != nullptr && force->with_torque) return kForceWithTorqueSize;
  return *payload_size(type_of(message));
}

void encode_payload(const Message& message, std::span<std::uint8_t> payload) {
  ByteWriter out(payload);
  std::visit([&out](const auto& each) { encode(each, out); }, message);
}

Message decode_payload(MessageType type, std::span<const std::uint8_t> payload) {
  ByteReader in(payload);
  switch (type) {
    case MessageType::kHello:
      return decode_hello(in);
    case MessageType::kWelcome:
      return decode_welcome(in);
    case MessageType::kRefuse:
      return decode_refuse(in);
    case MessageType::kGoodbye:
      return decode_goodbye(in);
    case MessageType::kSample:
      return decode_sample(in);
    case MessageType::kForce:
      return decode_force(in, payload.size() == kForceWithTorqueSize);
    case MessageType::kReport:
      return decode_report(in);
    case MessageType::kContactModel:
      return decode_contact_model(in);
    case MessageType::kAppliedForces:
      return decode_applied_forces(in);
    case MessageType::kStatus:
      return decode_status(in);
    case MessageType::kDatagrams:
      return decode_datagrams(in);
  }
  throw ProtocolError(ProtocolFault::kUnknownType,
                      "unknown message type " + std::to_string(static_cast<int>(type)));
}

}  // namespace irdm::wire
