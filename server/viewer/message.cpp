#include "server/viewer/message.hpp"

#include <algorithm>
#include <cmath>

#include "server/viewer/byte_stream.hpp"

namespace irdm::viewer {
namespace {

constexpr char kMagic[] = "IRVW";
enum class Type : std::uint16_t {
  kScene = 1,
  kFrame = 2,
  kHealth = 3,
  kState = 4,
  kHello = 16,
  kCommand = 17,
  kStylus = 18,
  kSettings = 19
};
constexpr std::uint32_t kLockstepFlag = 1;
constexpr std::uint32_t kFloorFlag = 2;
constexpr std::uint32_t kViewerStylusFlag = 4;
constexpr std::uint32_t kRecordedFlag = 8;

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

/// A count of objects or styluses.
std::size_t get_count(Reader& reader, int largest) {
  const auto count = reader.get<std::uint16_t>();
  if (count < 1 || count > largest) throw MessageError("a count is out of range");
  return count;
}

// Scene

void put_object(Writer& writer, const SceneObject& object) {
  const std::string name = object.name.substr(0, kMaxNameLength);
  writer.put(static_cast<std::uint32_t>(object.rest.rows()));
  writer.put(static_cast<std::uint32_t>(object.triangles.rows()));
  writer.put(static_cast<std::uint32_t>(name.size()));
  writer.put(object.mass);
  writer.put(object.stiffness);
  writer.put_zeros(4);
  writer.put_text(name);
  writer.align();
  for (Eigen::Index i = 0; i < object.rest.size(); ++i) {
    writer.put(static_cast<float>(object.rest.data()[i]));
  }
  for (Eigen::Index i = 0; i < object.triangles.size(); ++i) {
    writer.put(static_cast<std::uint32_t>(object.triangles.data()[i]));
  }
  const auto nodes = static_cast<std::size_t>(object.rest.rows());
  for (std::size_t i = 0; i < nodes; ++i) {
    writer.put(i < object.compliance.size() ? object.compliance[i]
                                            : std::numeric_limits<float>::quiet_NaN());
  }
}

SceneObject get_object(Reader& reader) {
  SceneObject object;
  const auto nodes = reader.get<std::uint32_t>();
  const auto triangles = reader.get<std::uint32_t>();
  const auto length = reader.get<std::uint32_t>();
  if (length > kMaxNameLength) throw MessageError("a name is too long");
  object.mass = reader.get_single();
  object.stiffness = reader.get_single();
  reader.skip(4);
  object.name = reader.get_text(length);
  reader.align();
  reader.expect(nodes, 12);
  object.rest.resize(nodes, 3);
  for (Eigen::Index i = 0; i < object.rest.size(); ++i) {
    object.rest.data()[i] = static_cast<double>(reader.get_single());
  }
  reader.expect(triangles, 12);
  object.triangles.resize(triangles, 3);
  for (Eigen::Index i = 0; i < object.triangles.size(); ++i) {
    const auto node = reader.get<std::uint32_t>();
    if (node >= nodes) throw MessageError("a triangle has a node that is not there");
    object.triangles.data()[i] = static_cast<int>(node);
  }
  reader.expect(nodes, 4);
  for (std::uint32_t i = 0; i < nodes; ++i) object.compliance.push_back(reader.get_single());
  return object;
}

// Frame

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
  const Quaternion& q = surface.orientation;
  for (const double part : {q.w(), q.x(), q.y(), q.z()}) writer.put(static_cast<float>(part));
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

}  // namespace

Bytes encode(const Scene& scene) {
  Bytes bytes;
  Writer writer(bytes);
  put_header(writer, Type::kScene);
  writer.put(static_cast<std::uint16_t>(scene.objects.size()));
  writer.put(static_cast<std::uint16_t>(scene.styluses.size()));
  writer.put((scene.lockstep ? kLockstepFlag : 0) | (scene.floor ? kFloorFlag : 0) |
             (scene.viewer_stylus ? kViewerStylusFlag : 0) | (scene.recorded ? kRecordedFlag : 0));
  writer.put(scene.dt);
  writer.put(scene.floor ? scene.floor->normal : Vector3::Zero().eval());
  writer.put(scene.floor ? scene.floor->height : 0.0);
  for (const SimulationStylus& stylus : scene.styluses) {
    writer.put(static_cast<float>(stylus.radius));
    writer.put(static_cast<float>(stylus.coupling_stiffness));
    writer.put(static_cast<float>(stylus.reach));
    writer.put(scene.viewer_stylus && &stylus == &scene.styluses.back() ? scene.max_force : 0.0F);
  }
  for (const SceneObject& object : scene.objects) put_object(writer, object);
  return bytes;
}

Scene decode_scene(std::span<const std::uint8_t> bytes) {
  Reader reader(bytes);
  expect_type(reader, Type::kScene);
  Scene scene;
  const std::size_t objects = get_count(reader, kMaxObjects);
  const std::size_t styluses = get_count(reader, kMaxStyluses);
  const auto flags = reader.get<std::uint32_t>();
  scene.lockstep = (flags & kLockstepFlag) != 0;
  scene.viewer_stylus = (flags & kViewerStylusFlag) != 0;
  scene.recorded = (flags & kRecordedFlag) != 0;
  scene.dt = reader.get_double();
  FloorConfig floor;
  floor.normal = reader.get_vector();
  floor.height = reader.get_double();
  if ((flags & kFloorFlag) != 0) scene.floor = floor;
  for (std::size_t s = 0; s < styluses; ++s) {
    SimulationStylus& stylus = scene.styluses.emplace_back();
    stylus.radius = static_cast<double>(reader.get_single());
    stylus.coupling_stiffness = static_cast<double>(reader.get_single());
    stylus.reach = static_cast<double>(reader.get_single());
    scene.max_force = reader.get_single();
  }
  for (std::size_t i = 0; i < objects; ++i) scene.objects.push_back(get_object(reader));
  reader.finish();
  return scene;
}

void encode(const SurfaceFrame& frame, Bytes& bytes) {
  Writer writer(bytes);
  put_header(writer, Type::kFrame);
  const int steps = frame.trail.count();
  writer.put(static_cast<std::uint16_t>(frame.objects.size()));
  writer.put(static_cast<std::uint16_t>(frame.styluses.size()));
  writer.put(static_cast<std::uint16_t>(steps));
  writer.put_zeros(2);
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
}

namespace {

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
  std::array<double, 4> q{};
  for (double& part : q) part = static_cast<double>(reader.get_single());
  surface.orientation = Quaternion(q[0], q[1], q[2], q[3]);
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

}  // namespace

SurfaceFrame decode_frame(std::span<const std::uint8_t> bytes, std::span<const std::size_t> nodes) {
  Reader reader(bytes);
  expect_type(reader, Type::kFrame);
  SurfaceFrame frame;
  const std::size_t objects = get_count(reader, kMaxObjects);
  if (objects != nodes.size()) throw MessageError("another number of objects than in the scene");
  const std::size_t styluses = get_count(reader, kMaxStyluses);
  const int steps = reader.get<std::uint16_t>();
  if (steps > ForceTrail::kLength) throw MessageError("the trail of forces is too long");
  reader.skip(2);
  frame.force_step = reader.get<std::uint64_t>();
  frame.time = reader.get_double();
  frame.contacts.resize(styluses);
  for (StylusContact& contact : frame.contacts) {
    frame.styluses.push_back(get_stylus(reader, contact));
  }
  frame.trail = get_trail(reader, steps, styluses, frame.force_step);
  for (const std::size_t count : nodes) frame.objects.push_back(get_surface(reader, count));
  reader.finish();
  return frame;
}

namespace {

void put_percentiles(Writer& writer, const Percentiles& value) {
  for (const float part : {value.p50, value.p99, value.max}) writer.put(part);
}

Percentiles get_percentiles(Reader& reader) {
  const float p50 = reader.get_single();
  const float p99 = reader.get_single();
  return {p50, p99, reader.get_single()};
}

}  // namespace

Bytes encode(const Health& health) {
  Bytes bytes;
  Writer writer(bytes);
  put_header(writer, Type::kHealth);
  writer.put(health.steps);
  put_percentiles(writer, health.step_time);
  put_percentiles(writer, health.wakeup_delay);
  for (const std::uint64_t count :
       {health.missed, health.unsolved, health.resets, health.lost_steps}) {
    writer.put(count);
  }
  writer.put(health.surface_rate);
  writer.put(health.viewers);
  for (const std::uint64_t count : {health.sessions, health.samples, health.forces,
                                    health.forces_replaced, health.protocol_errors}) {
    writer.put(count);
  }
  writer.put(static_cast<std::uint16_t>(health.links.size()));
  writer.put_zeros(6);
  for (const LinkHealth& link : health.links) {
    writer.put(std::uint32_t{link.reported ? 1U : 0U});
    put_percentiles(writer, link.round_trip);
    put_percentiles(writer, link.age);
    writer.put_zeros(4);
  }
  return bytes;
}

Health decode_health(std::span<const std::uint8_t> bytes) {
  Reader reader(bytes);
  expect_type(reader, Type::kHealth);
  Health health;
  health.steps = reader.get<std::uint64_t>();
  health.step_time = get_percentiles(reader);
  health.wakeup_delay = get_percentiles(reader);
  for (std::uint64_t* count :
       {&health.missed, &health.unsolved, &health.resets, &health.lost_steps}) {
    *count = reader.get<std::uint64_t>();
  }
  health.surface_rate = reader.get_single();
  health.viewers = reader.get<std::uint32_t>();
  for (std::uint64_t* count : {&health.sessions, &health.samples, &health.forces,
                               &health.forces_replaced, &health.protocol_errors}) {
    *count = reader.get<std::uint64_t>();
  }
  const auto links = reader.get<std::uint16_t>();
  if (links > kMaxStyluses) throw MessageError("a count is out of range");
  reader.skip(6);
  for (std::uint16_t i = 0; i < links; ++i) {
    LinkHealth& link = health.links.emplace_back();
    link.reported = reader.get<std::uint32_t>() == 1;
    link.round_trip = get_percentiles(reader);
    link.age = get_percentiles(reader);
    reader.skip(4);
  }
  reader.finish();
  return health;
}

// State and Settings

namespace {

void put_settings(Writer& writer, const ObjectSettings& settings, const SettingsChoice& choice) {
  for (const double value :
       {settings.friction.static_, settings.friction.kinetic, settings.damping.linear,
        settings.damping.angular, settings.tether.stiffness, settings.tether.angular_stiffness,
        settings.material_damping}) {
    writer.put(value);
  }
  writer.put(static_cast<std::uint8_t>(settings.engine == EngineKind::kDense ? 1 : 0));
  writer.put(static_cast<std::uint8_t>(settings.inertial_loading ? 1 : 0));
  writer.put(static_cast<std::uint8_t>((choice.material_damping ? 1 : 0) | (choice.engine ? 2 : 0) |
                                       (choice.inertial_loading ? 4 : 0)));
  writer.put_zeros(21);
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
  settings.material_damping = get_between(reader, 0.1, 10.0);
  const auto engine = reader.get<std::uint8_t>();
  const auto loading = reader.get<std::uint8_t>();
  const auto choices = reader.get<std::uint8_t>();
  if (engine > 1 || loading > 1) throw MessageError("a setting is out of range");
  settings.engine = engine == 1 ? EngineKind::kDense : EngineKind::kModal;
  settings.inertial_loading = loading == 1;
  choice = {(choices & 1) != 0, (choices & 2) != 0, (choices & 4) != 0};
  reader.skip(21);
  return settings;
}

Vector3 get_bounded_vector(Reader& reader, double largest) {
  Vector3 v;
  for (double& part : v) part = get_between(reader, -largest, largest);
  return v;
}

constexpr double kMostGravity = 100.0;  // [m/s^2]

/// The flags of a State, bit by bit.
template <typename AnyState>
auto flags_of(AnyState& state) {
  return std::array{&state.looks_on,  &state.stylus_free, &state.holds_stylus, &state.paused,
                    &state.recording, &state.playback,    &state.playing,      &state.can_record};
}

}  // namespace

Bytes encode(const State& state) {
  Bytes bytes;
  Writer writer(bytes);
  put_header(writer, Type::kState);
  std::uint32_t flags = 0;
  std::uint32_t bit = 1;
  for (const bool* flag : flags_of(state)) {
    if (*flag) flags |= bit;
    bit <<= 1U;
  }
  const std::string notice = state.notice.substr(0, kMaxNotice);
  const std::size_t recordings = std::min(state.recordings.size(), kMaxRecordings);
  writer.put(flags);
  writer.put(state.settings_changes);
  writer.put(state.length);
  writer.put(state.speed);
  writer.put(state.shown);
  writer.put(static_cast<std::uint16_t>(recordings));
  writer.put(static_cast<std::uint16_t>(notice.size()));
  writer.put_zeros(2);
  writer.put(state.settings.gravity);
  for (std::size_t i = 0; i < state.choices.size(); ++i) {
    put_settings(writer, state.settings.object[i], state.choices[i]);
  }
  for (std::size_t i = 0; i < recordings; ++i) {
    const std::string name = state.recordings[i].name.substr(0, kMaxRecordingName);
    writer.put(state.recordings[i].number);
    writer.put(static_cast<std::uint16_t>(name.size()));
    writer.put_text(name);
    writer.put_zeros(kMaxRecordingName - name.size());
  }
  writer.put_text(notice);
  writer.align();
  return bytes;
}

State decode_state(std::span<const std::uint8_t> bytes, std::size_t objects) {
  Reader reader(bytes);
  expect_type(reader, Type::kState);
  State state;
  auto flags = reader.get<std::uint32_t>();
  for (bool* flag : flags_of(state)) {
    *flag = (flags & 1U) != 0;
    flags >>= 1U;
  }
  state.settings_changes = reader.get<std::uint32_t>();
  state.length = reader.get_double();
  state.speed = reader.get_double();
  state.shown = reader.get<std::uint16_t>();
  const auto recordings = reader.get<std::uint16_t>();
  const auto notice = reader.get<std::uint16_t>();
  if (recordings > kMaxRecordings || notice > kMaxNotice) {
    throw MessageError("a count is out of range");
  }
  reader.skip(2);
  state.settings.gravity = get_bounded_vector(reader, kMostGravity);
  for (std::size_t i = 0; i < objects; ++i) {
    state.settings.object.at(i) = get_settings(reader, state.choices.emplace_back());
  }
  for (std::uint16_t i = 0; i < recordings; ++i) {
    const auto number = reader.get<std::uint16_t>();
    const auto length = reader.get<std::uint16_t>();
    if (length > kMaxRecordingName) throw MessageError("a name is too long");
    state.recordings.push_back({number, reader.get_text(length)});
    reader.skip(kMaxRecordingName - length);
  }
  state.notice = reader.get_text(notice);
  reader.align();
  reader.finish();
  return state;
}

// From viewers

namespace {

struct ClientEncoder {
  Writer& writer;

  void operator()(const Hello& hello) const {
    const std::string token = hello.token.substr(0, kMaxTokenLength);
    put_header(writer, Type::kHello);
    writer.put(static_cast<std::uint16_t>(token.size()));
    writer.put(static_cast<std::uint16_t>(hello.looks_on ? 1 : 0));
    writer.put_text(token);
  }
  void operator()(const Command& command) const {
    put_header(writer, Type::kCommand);
    writer.put(static_cast<std::uint16_t>(command.kind));
    writer.put(command.number);
    writer.put_zeros(4);
    writer.put(command.value);
  }
  void operator()(const StylusRequest& stylus) const {
    put_header(writer, Type::kStylus);
    writer.put(static_cast<std::uint8_t>(stylus.present ? 1 : 0));
    writer.put_zeros(3);
    writer.put(stylus.buttons);
    writer.put(stylus.tip);
  }
  void operator()(const SettingsRequest& request) const {
    put_header(writer, Type::kSettings);
    writer.put(static_cast<std::uint16_t>(request.objects));
    writer.put_zeros(6);
    writer.put(request.settings.gravity);
    for (std::size_t i = 0; i < request.objects; ++i) {
      put_settings(writer, request.settings.object.at(i), {});
    }
  }
};

Hello get_hello(Reader& reader) {
  const auto length = reader.get<std::uint16_t>();
  if (length > kMaxTokenLength) throw MessageError("its token is too long");
  const auto looks_on = reader.get<std::uint16_t>();
  if (looks_on > 1) throw MessageError("a number is out of range");
  return {reader.get_text(length), looks_on == 1};
}

Command get_command(Reader& reader) {
  const auto kind = reader.get<std::uint16_t>();
  if (kind < static_cast<std::uint16_t>(CommandKind::kPutBack) ||
      kind > static_cast<std::uint16_t>(CommandKind::kSetSpeed)) {
    throw MessageError("the command is unknown");
  }
  Command command;
  command.kind = static_cast<CommandKind>(kind);
  command.number = reader.get<std::uint16_t>();
  reader.skip(4);
  command.value = reader.get_double();
  const auto value_between = [&](double least, double largest) {
    if (!(command.value >= least && command.value <= largest)) {
      throw MessageError("a number is out of range");
    }
  };
  if (command.kind == CommandKind::kStep && (command.number < 1 || command.number > 1000)) {
    throw MessageError("a number is out of range");
  }
  if (command.kind == CommandKind::kSeek) value_between(0.0, 1e9);
  if (command.kind == CommandKind::kSetSpeed) value_between(0.01, 10.0);
  return command;
}

StylusRequest get_stylus_request(Reader& reader) {
  StylusRequest stylus;
  const auto present = reader.get<std::uint8_t>();
  if (present > 1) throw MessageError("a number is out of range");
  stylus.present = present == 1;
  reader.skip(3);
  stylus.buttons = reader.get<std::uint32_t>();
  stylus.tip = get_bounded_vector(reader, kFarthest);
  return stylus;
}

SettingsRequest get_settings_request(Reader& reader) {
  SettingsRequest request;
  request.objects = get_count(reader, kMaxObjects);
  reader.skip(6);
  request.settings.gravity = get_bounded_vector(reader, kMostGravity);
  SettingsChoice ignored;
  for (std::size_t i = 0; i < request.objects; ++i) {
    request.settings.object.at(i) = get_settings(reader, ignored);
  }
  return request;
}

ClientMessage get_client_message(Reader& reader) {
  switch (get_header(reader)) {
    case Type::kHello:
      return get_hello(reader);
    case Type::kCommand:
      return get_command(reader);
    case Type::kStylus:
      return get_stylus_request(reader);
    case Type::kSettings:
      return get_settings_request(reader);
    default:
      throw MessageError("it is of another type");
  }
}

}  // namespace

Bytes encode(const ClientMessage& message) {
  Bytes bytes;
  Writer writer(bytes);
  std::visit(ClientEncoder{writer}, message);
  return bytes;
}

ClientMessage decode_client(std::span<const std::uint8_t> bytes) {
  Reader reader(bytes);
  ClientMessage message = get_client_message(reader);
  reader.finish();
  return message;
}

}  // namespace irdm::viewer
