#include "common/wire/payload.hpp"

#include <cmath>
#include <string>

#include "common/wire/protocol_error.hpp"

namespace irdm::wire {
namespace {

// Bits of a contact model's flags.
constexpr std::uint16_t kValid = 1u << 0;
constexpr std::uint16_t kSlipping = 1u << 1;
constexpr std::uint16_t kPaused = 1u << 2;
constexpr std::uint16_t kFixed = 1u << 3;
constexpr std::uint16_t kAllFlags = kValid | kSlipping | kPaused | kFixed;

[[noreturn]] void bad_contact_value(const std::string& what) {
  throw ProtocolError(ProtocolFault::kBadValue, what);
}

[[noreturn]] void not_finite(const char* what) {
  throw ProtocolError(ProtocolFault::kNotFinite, std::string(what) + " is not finite");
}

double get_finite(ByteReader& in, const char* what) {
  const double value = in.get_number();
  if (!std::isfinite(value)) not_finite(what);
  return value;
}

Vector3 get_finite_vector(ByteReader& in, const char* what) {
  const Vector3 value = in.get_vector();
  if (!value.allFinite()) not_finite(what);
  return value;
}

Quaternion get_finite_quaternion(ByteReader& in, const char* what) {
  const Quaternion value = in.get_quaternion();
  if (!value.coeffs().allFinite()) not_finite(what);
  return value;
}

// A symmetric matrix: xx, yy, zz, xy, xz, yz.
void put_symmetric(const Matrix3& m, ByteWriter& out) {
  for (int i = 0; i < 3; ++i) out.put(m(i, i));
  out.put(m(0, 1));
  out.put(m(0, 2));
  out.put(m(1, 2));
}

Matrix3 get_symmetric(ByteReader& in, const char* what) {
  Matrix3 m;
  for (int i = 0; i < 3; ++i) m(i, i) = get_finite(in, what);
  m(0, 1) = m(1, 0) = get_finite(in, what);
  m(0, 2) = m(2, 0) = get_finite(in, what);
  m(1, 2) = m(2, 1) = get_finite(in, what);
  return m;
}

std::uint16_t flags(const ContactModel& model) {
  unsigned bits = 0;
  if (model.valid) bits |= kValid;
  if (model.slipping) bits |= kSlipping;
  if (model.paused) bits |= kPaused;
  if (model.body.support == Support::kFixed) bits |= kFixed;
  return static_cast<std::uint16_t>(bits);
}

void put_body(const ContactModel& model, ByteWriter& out) {
  out.put(model.body.mass);
  put_symmetric(model.body.inertia, out);
  out.put(model.motion.position);
  out.put(model.motion.orientation);
  out.put(model.motion.velocity);
  out.put(model.motion.angular_momentum);
}

void get_body(ByteReader& in, ContactModel& model) {
  model.body.mass = get_finite(in, "the mass");
  model.body.inertia = get_symmetric(in, "the inertia");
  model.motion.position = get_finite_vector(in, "the position");
  model.motion.orientation = get_finite_quaternion(in, "the orientation");
  model.motion.velocity = get_finite_vector(in, "the velocity");
  model.motion.angular_momentum = get_finite_vector(in, "the angular momentum");
}

void put_drives(const ContactModel& model, ByteWriter& out) {
  const FreeForces& forces = model.free_forces;
  out.put(forces.gravity);
  out.put(forces.damping.linear);
  out.put(forces.damping.angular);
  out.put(forces.tether.stiffness);
  out.put(forces.tether.angular_stiffness);
  out.put(forces.home_position);
  out.put(forces.home_orientation);
  out.put(model.other_force);
  out.put(model.other_torque);
}

void get_drives(ByteReader& in, ContactModel& model) {
  FreeForces& forces = model.free_forces;
  forces.gravity = get_finite_vector(in, "gravity");
  forces.damping.linear = get_finite(in, "a damping");
  forces.damping.angular = get_finite(in, "a damping");
  forces.tether.stiffness = get_finite(in, "a tether");
  forces.tether.angular_stiffness = get_finite(in, "a tether");
  forces.home_position = get_finite_vector(in, "a tether's place");
  forces.home_orientation = get_finite_quaternion(in, "a tether's orientation");
  model.other_force = get_finite_vector(in, "a force");
  model.other_torque = get_finite_vector(in, "a torque");
}

}  // namespace

// What no valid model says is written as zeros.
void encode(const ContactModelMessage& message, ByteWriter& out) {
  const ContactModel& model = message.model;
  out.put(message.stylus);
  out.put(flags(model));
  out.put(static_cast<std::uint16_t>(model.state));
  out.put(static_cast<std::uint16_t>(model.valid ? model.horizon : 0));
  out.put(model.step);
  out.put(model.missing);
  out.put(model.newest);
  out.put(model.dt);
  if (!model.valid) return out.put_zeros(kContactModelSize - 40);
  out.put(model.energy);
  put_body(model, out);
  put_drives(model, out);
  out.put(model.place);
  out.put(model.normal);
  out.put(model.friction.static_);
  out.put(model.friction.kinetic);
  put_symmetric(model.series, out);
  for (int n = 0; n < kMaxHorizon; ++n) {
    const auto i = static_cast<std::size_t>(n);
    if (n >= model.horizon) {
      out.put_zeros(72);
      continue;
    }
    out.put(model.path[i]);
    put_symmetric(model.response[i], out);
  }
}

ContactModelMessage decode_contact_model(ByteReader& in) {
  ContactModelMessage message;
  ContactModel& model = message.model;
  message.stylus = in.get<std::uint16_t>();
  const auto bits = in.get<std::uint16_t>();
  if ((bits & ~unsigned{kAllFlags}) != 0)
    bad_contact_value("the flags are " + std::to_string(bits));
  model.valid = (bits & kValid) != 0;
  model.slipping = (bits & kSlipping) != 0;
  model.paused = (bits & kPaused) != 0;
  model.body.support = (bits & kFixed) != 0 ? Support::kFixed : Support::kFloating;
  const auto state = in.get<std::uint16_t>();
  if (state > 2) bad_contact_value("the contact state is " + std::to_string(state));
  model.state = static_cast<ContactState>(state);
  model.horizon = in.get<std::uint16_t>();
  if (model.horizon > kMaxHorizon || (model.horizon == 0) == model.valid) {
    bad_contact_value("the horizon is " + std::to_string(model.horizon));
  }
  model.step = in.get<std::uint64_t>();
  model.missing = in.get<std::uint64_t>();
  model.newest = in.get<std::uint64_t>();
  model.dt = get_finite(in, "dt");
  if (!model.valid) return message;
  model.energy = get_finite(in, "the energy");
  get_body(in, model);
  get_drives(in, model);
  model.place = get_finite_vector(in, "the place");
  model.normal = get_finite_vector(in, "the normal");
  model.friction.static_ = in.get_number();  // may be infinite
  model.friction.kinetic = in.get_number();
  model.series = get_symmetric(in, "a compliance");
  for (int n = 0; n < model.horizon; ++n) {
    const auto i = static_cast<std::size_t>(n);
    model.path[i] = get_finite_vector(in, "a path");
    model.response[i] = get_symmetric(in, "a response");
  }
  return message;
}

void encode(const AppliedForcesMessage& message, ByteWriter& out) {
  const AppliedForces& applied = message.applied;
  out.put(message.stylus);
  out.put(static_cast<std::uint16_t>(applied.count));
  out.put_zeros(4);
  out.put(applied.step);
  out.put(applied.base);
  for (int i = 0; i < AppliedForces::kSteps; ++i) {
    if (i >= applied.count) {
      out.put_zeros(72);
      continue;
    }
    const AppliedForce& each = applied.past[static_cast<std::size_t>(i)];
    out.put(each.force);
    out.put(each.tip);
    out.put(each.arm);
  }
}

AppliedForcesMessage decode_applied_forces(ByteReader& in) {
  AppliedForcesMessage message;
  AppliedForces& applied = message.applied;
  message.stylus = in.get<std::uint16_t>();
  applied.count = in.get<std::uint16_t>();
  in.skip(4);
  applied.step = in.get<std::uint64_t>();
  applied.base = in.get<std::uint64_t>();
  if (applied.count < 1 || applied.count > AppliedForces::kSteps) {
    bad_contact_value("the count of forces is " + std::to_string(applied.count));
  }
  if (applied.step == kNoStep || applied.step + 1 < static_cast<std::uint64_t>(applied.count)) {
    bad_contact_value("forces of steps before the first");
  }
  for (int i = 0; i < applied.count; ++i) {
    AppliedForce& each = applied.past[static_cast<std::size_t>(i)];
    each.force = get_finite_vector(in, "a force");
    each.tip = get_finite_vector(in, "the tip");
    if (each.force.cwiseAbs().maxCoeff() > kMaxForce) bad_contact_value("a force is too large");
    each.arm = get_finite_vector(in, "the arm");
    if (each.tip.cwiseAbs().maxCoeff() > kMaxCoordinate) bad_contact_value("the tip is too far");
    if (each.arm.cwiseAbs().maxCoeff() > kMaxCoordinate) bad_contact_value("the arm is too long");
  }
  return message;
}

}  // namespace irdm::wire
