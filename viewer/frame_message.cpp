#include <algorithm>
#include <cmath>

#include "viewer/message_parts.hpp"

namespace irdm::viewer {
namespace {

void put_stylus(Writer& writer, const StylusRecord& stylus, const StylusContact& contact) {
  writer.put(static_cast<std::uint8_t>(stylus.present ? 1 : 0));
  writer.put(static_cast<std::uint8_t>(stylus.contact));
  writer.put(static_cast<std::uint16_t>(static_cast<std::int16_t>(stylus.object)));
  writer.put(stylus.buttons);
  writer.put(stylus.tip);
  writer.put(stylus.proxy);
  writer.put(Eigen::Vector3f(stylus.force.cast<float>()));
  const bool free = stylus.contact == ContactState::kFree;
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  writer.put(free ? Eigen::Vector3f(kNone, kNone, kNone) : contact.place.cast<float>().eval());
  writer.put(static_cast<std::uint8_t>(!free && contact.slipping ? 1 : 0));
  writer.put_zeros(7);
}

StylusRecord get_stylus(Reader& reader, StylusContact& place) {
  StylusRecord stylus;
  const auto present = reader.get<std::uint8_t>();
  const auto contact = reader.get<std::uint8_t>();
  if (present > 1 || contact > 2) throw MessageError("a stylus is out of range");
  stylus.present = present == 1;
  stylus.contact = static_cast<ContactState>(contact);
  stylus.object = static_cast<std::int16_t>(reader.get<std::uint16_t>());
  stylus.buttons = reader.get<std::uint32_t>();
  stylus.tip = reader.get_vector();
  stylus.proxy = reader.get_vector();
  stylus.force = reader.get_single_vector().cast<double>();
  place.place = reader.get_single_vector().cast<double>();
  const auto slipping = reader.get<std::uint8_t>();
  if (slipping > 1) throw MessageError("a stylus is out of range");
  place.slipping = slipping == 1;
  reader.skip(7);
  return stylus;
}

/// How displacements become whole numbers.
struct Quantisation {
  float unit;  ///< [m]
  bool wide;   ///< 4 bytes instead of 2
};

Quantisation quantisation(const Points& displacement) {
  constexpr double kLargest = std::numeric_limits<std::int16_t>::max();
  double largest = 0.0;
  for (Eigen::Index i = 0; i < displacement.size(); ++i) {
    const double size = std::abs(displacement.data()[i]);
    if (std::isfinite(size)) largest = std::max(largest, size);
  }
  // A unit that single precision has rounded down would take the largest number beyond 2 bytes.
  constexpr double kSmallest = 1e-12;
  const auto unit = static_cast<float>(std::max(kSmallest, largest / kLargest * (1.0 + 1e-7)));
  if (static_cast<double>(unit) <= kCoarsestUnit) return {unit, false};
  // The nearest single precision number is just above 1e-5.
  return {std::nextafter(static_cast<float>(kCoarsestUnit), 0.0F), true};
}

template <typename Signed>
void put_displacements(Writer& writer, const Points& displacement, float unit) {
  using Unsigned = std::make_unsigned_t<Signed>;
  constexpr double kLargest = std::numeric_limits<Signed>::max();
  for (Eigen::Index i = 0; i < displacement.size(); ++i) {
    const double value = displacement.data()[i] / static_cast<double>(unit);
    const double number =
        std::isnan(value) || std::isinf(displacement.data()[i]) ? 0.0 : std::round(value);
    writer.put(static_cast<Unsigned>(static_cast<Signed>(std::clamp(number, -kLargest, kLargest))));
  }
}

void put_surface(Writer& writer, const ObjectSurface& surface) {
  const Quantisation form = quantisation(surface.displacement);
  writer.put(surface.position);
  put_orientation(writer, surface.orientation);
  writer.put(static_cast<std::uint8_t>(form.wide ? 4 : 2));
  writer.put_zeros(3);
  writer.put(form.unit);
  if (form.wide) {
    put_displacements<std::int32_t>(writer, surface.displacement, form.unit);
  } else {
    put_displacements<std::int16_t>(writer, surface.displacement, form.unit);
  }
  writer.align();
}

ForceTrail get_trail(Reader& reader, int steps, std::size_t styluses, std::uint64_t newest) {
  ForceTrail trail;
  StepRecord record;
  for (int i = 0; i < steps; ++i) {
    record.force_step = newest - static_cast<std::uint64_t>(steps - 1 - i);
    for (std::size_t s = 0; s < styluses; ++s) {
      record.stylus[s].force = reader.get_single_vector().cast<double>();
    }
    trail.follow(record);
  }
  return trail;
}

double get_number(Reader& reader, bool wide) {
  return wide ? static_cast<std::int32_t>(reader.get<std::uint32_t>())
              : static_cast<std::int16_t>(reader.get<std::uint16_t>());
}

ObjectSurface get_surface(Reader& reader, std::size_t nodes) {
  ObjectSurface surface;
  surface.position = reader.get_vector();
  surface.orientation = get_orientation(reader);
  const auto width = reader.get<std::uint8_t>();
  if (width != 2 && width != 4) throw MessageError("numbers of an unknown size");
  reader.skip(3);
  const auto unit = static_cast<double>(reader.get_single());
  reader.expect(nodes, 3u * width);
  surface.displacement.resize(static_cast<Eigen::Index>(nodes), 3);
  for (Eigen::Index i = 0; i < surface.displacement.size(); ++i) {
    surface.displacement.data()[i] = unit * get_number(reader, width == 4);
  }
  reader.align();
  return surface;
}

constexpr double kNormalUnits = std::numeric_limits<std::int16_t>::max();

void put_body_contact(Writer& writer, const BodyContactRecord& contact) {
  writer.put(static_cast<std::uint8_t>(contact.object));
  writer.put(static_cast<std::uint8_t>(static_cast<std::int8_t>(contact.other)));
  for (const double part : contact.normal) {
    const double number =
        std::isnan(part) ? 0.0 : std::round(kNormalUnits * std::clamp(part, -1.0, 1.0));
    writer.put(static_cast<std::uint16_t>(static_cast<std::int16_t>(number)));
  }
  writer.put(Eigen::Vector3f(contact.position.cast<float>()));
  writer.put(Eigen::Vector3f(contact.force.cast<float>()));
  writer.put(static_cast<float>(contact.area));
}

BodyContactRecord get_body_contact(Reader& reader, int objects) {
  BodyContactRecord contact;
  contact.object = reader.get<std::uint8_t>();
  contact.other = static_cast<std::int8_t>(reader.get<std::uint8_t>());
  constexpr int kMost = static_cast<int>(kMaxScenery) + kMaxStyluses;  // scenery and balls
  if (contact.object >= objects || contact.other >= objects || -1 - contact.other >= kMost) {
    throw MessageError("a contact is out of range");
  }
  for (double& part : contact.normal) part = get_number(reader, false) / kNormalUnits;
  contact.position = reader.get_single_vector().cast<double>();
  contact.force = reader.get_single_vector().cast<double>();
  contact.area = static_cast<double>(reader.get_single());
  return contact;
}

}  // namespace

void encode(const SurfaceFrame& frame, Bytes& bytes) {
  Writer writer(bytes);
  put_header(writer, Type::kFrame);
  const int steps = frame.trail.count();
  writer.put(static_cast<std::uint16_t>(frame.objects.size()));
  writer.put(static_cast<std::uint16_t>(frame.styluses.size()));
  writer.put(static_cast<std::uint16_t>(steps));
  writer.put(static_cast<std::uint16_t>(frame.body_contacts.size()));
  writer.put(frame.force_step);
  writer.put(frame.time);
  for (std::size_t s = 0; s < frame.styluses.size(); ++s) {
    put_stylus(writer, frame.styluses[s],
               s < frame.contacts.size() ? frame.contacts[s] : StylusContact{});
  }
  for (int back = steps - 1; back >= 0; --back) {
    for (std::size_t s = 0; s < frame.styluses.size(); ++s) {
      writer.put(frame.trail.force(back, static_cast<int>(s)));
    }
  }
  for (const ObjectSurface& surface : frame.objects) put_surface(writer, surface);
  for (const BodyContactRecord& contact : frame.body_contacts) put_body_contact(writer, contact);
}

SurfaceFrame decode_frame(std::span<const std::uint8_t> bytes, std::span<const std::size_t> nodes) {
  Reader reader(bytes);
  expect_type(reader, Type::kFrame);
  SurfaceFrame frame;
  const std::size_t objects = get_count(reader, kMaxObjects);
  if (objects != nodes.size()) throw MessageError("another number of objects than in the scene");
  const std::size_t styluses = get_count(reader, kMaxStyluses);
  const int steps = reader.get<std::uint16_t>();
  if (steps > ForceTrail::kLength) throw MessageError("the trail of forces is too long");
  const int contacts = reader.get<std::uint16_t>();
  if (contacts > kMaxBodyContacts) throw MessageError("there are too many contacts");
  frame.force_step = reader.get<std::uint64_t>();
  frame.time = reader.get_double();
  frame.contacts.resize(styluses);
  for (StylusContact& contact : frame.contacts) {
    frame.styluses.push_back(get_stylus(reader, contact));
  }
  frame.trail = get_trail(reader, steps, styluses, frame.force_step);
  for (const std::size_t count : nodes) frame.objects.push_back(get_surface(reader, count));
  for (int i = 0; i < contacts; ++i) {
    frame.body_contacts.push_back(get_body_contact(reader, static_cast<int>(objects)));
  }
  reader.finish();
  return frame;
}

}  // namespace irdm::viewer
