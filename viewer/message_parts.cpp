#include "viewer/message_parts.hpp"

#include <array>

#include "common/config/range.hpp"

namespace irdm::viewer {
namespace {
constexpr char kMagic[] = "IRVW";
}  // namespace

void put_header(Writer& writer, Type type) {
  writer.put_text(kMagic);
  writer.put(kVersion);
  writer.put(static_cast<std::uint16_t>(type));
}

Type get_header(Reader& reader) {
  if (reader.get_text(4) != kMagic) throw MessageError("it does not begin with IRVW");
  if (reader.get<std::uint16_t>() != kVersion) throw MessageError("it is of another version");
  return static_cast<Type>(reader.get<std::uint16_t>());
}

void expect_type(Reader& reader, Type type) {
  if (get_header(reader) != type) throw MessageError("it is of another type");
}

std::size_t get_count(Reader& reader, int largest) {
  const auto count = reader.get<std::uint16_t>();
  if (count < 1 || count > largest) throw MessageError("a count is out of range");
  return count;
}

void put_orientation(Writer& writer, const Quaternion& q) {
  for (const double part : {q.w(), q.x(), q.y(), q.z()}) writer.put(static_cast<float>(part));
}

Quaternion get_orientation(Reader& reader) {
  std::array<double, 4> q{};
  for (double& part : q) part = static_cast<double>(reader.get_single());
  return {q[0], q[1], q[2], q[3]};
}

void put_settings(Writer& writer, const ObjectSettings& settings, const SettingsChoice& choice) {
  for (const double value :
       {settings.friction.static_, settings.friction.kinetic, settings.damping.linear,
        settings.damping.angular, settings.tether.stiffness, settings.tether.angular_stiffness,
        settings.material_damping}) {
    writer.put(value);
  }
  writer.put(static_cast<std::uint8_t>(settings.inertial_loading ? 1 : 0));
  writer.put(static_cast<std::uint8_t>((choice.material_damping ? 1 : 0) |
                                       (choice.inertial_loading ? 2 : 0) |
                                       (choice.motion ? 0 : 4)));
  writer.put_zeros(22);
}

double get_between(Reader& reader, double least, double largest) {
  const double value = reader.get_double();
  if (!(value >= least && value <= largest)) throw MessageError("a number is out of range");
  return value;
}

ObjectSettings get_settings(Reader& reader, SettingsChoice& choice) {
  constexpr double kMost = 1e9;  // what the step bears is less, and another's concern
  ObjectSettings settings;
  settings.friction.static_ = get_between(reader, 0.0, 10.0);
  settings.friction.kinetic = get_between(reader, 0.0, settings.friction.static_);
  settings.damping.linear = get_between(reader, 0.0, kMost);
  settings.damping.angular = get_between(reader, 0.0, kMost);
  settings.tether.stiffness = get_between(reader, 0.0, kMost);
  settings.tether.angular_stiffness = get_between(reader, 0.0, kMost);
  settings.material_damping =
      get_between(reader, lab::kMaterialDamping.lowest, lab::kMaterialDamping.highest);
  const auto loading = reader.get<std::uint8_t>();
  const auto choices = reader.get<std::uint8_t>();
  if (loading > 1) throw MessageError("a setting is out of range");
  settings.inertial_loading = loading == 1;
  choice = {(choices & 1) != 0, (choices & 2) != 0, (choices & 4) == 0};
  reader.skip(22);
  return settings;
}

Vector3 get_bounded_vector(Reader& reader, double largest) {
  Vector3 v;
  for (double& part : v) part = get_between(reader, -largest, largest);
  return v;
}

}  // namespace irdm::viewer
