#include "server/record/recording.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <mutex>
#include <string>

#include "common/error.hpp"
#include "common/hdf5/library_lock.hpp"
#include "common/motion/rigid_body.hpp"
#include "server/record/trace_paths.hpp"
#include "server/step/soft_object.hpp"

namespace irdm {
namespace {

std::size_t at(std::size_t row, std::size_t width) {
  return row * width;
}

Vector3 vector_of(const std::vector<double>& values, std::size_t row) {
  return Eigen::Map<const Vector3>(values.data() + at(row, 3));
}

/// Reads sets of as many rows as the trace has steps.
class RowReader {
 public:
  explicit RowReader(const hdf5::File& file) : file_(file) {
    const hdf5::Shape steps = file.stored_shape("/step/time");
    if (steps.size() != 1) throw Error(file.name(), "/step/time is no list", "record it again");
    rows_ = steps[0];
    if (!file.exists(trace::kCommitted)) return;  // an older trace
    rows_ = std::min<hsize_t>(rows_, file.read<std::uint64_t>(trace::kCommitted, {1})[0]);
  }

  hsize_t rows() const { return rows_; }
  template <typename T>
  std::vector<T> read(const std::string& set, hsize_t width = 1) const {
    const hdf5::Shape shape = file_.stored_shape(set);
    const hdf5::Shape wanted = width == 1 ? hdf5::Shape{rows_} : hdf5::Shape{rows_, width};
    if (shape.size() != wanted.size() || shape[0] < rows_ || (width > 1 && shape[1] != width)) {
      throw Error(file_.name(), set + " does not have a row for each step", "record it again");
    }
    std::vector<T> values(rows_ * width);
    if (rows_ > 0) {
      file_.read_slab<T>(set, hdf5::Shape(wanted.size(), 0), wanted, values.data());
    }
    return values;
  }

 private:
  const hdf5::File& file_;
  hsize_t rows_ = 0;
};

/// Reads sets with a row for each event: as many rows as all of them have. A server that was
/// killed may leave some that are longer.
class EventReader {
 public:
  EventReader(const hdf5::File& file, std::string group, const std::vector<const char*>& sets)
      : file_(file), group_(std::move(group)) {
    rows_ = std::numeric_limits<hsize_t>::max();
    for (const char* set : sets) {
      const hdf5::Shape shape = file_.stored_shape(group_ + set);
      rows_ = std::min<hsize_t>(rows_, shape.empty() ? 0 : shape[0]);
    }
  }

  hsize_t rows() const { return rows_; }
  template <typename T>
  std::vector<T> read(const char* set, hsize_t width = 1) const {
    const hdf5::Shape shape = file_.stored_shape(group_ + set);
    if (shape.size() != (width == 1 ? 1 : 2) || (width > 1 && shape[1] != width)) {
      throw Error(file_.name(), group_ + set + " has not the right shape", "record it again");
    }
    const hdf5::Shape wanted = width == 1 ? hdf5::Shape{rows_} : hdf5::Shape{rows_, width};
    std::vector<T> values(rows_ * width);
    if (rows_ > 0) {
      file_.read_slab<T>(group_ + set, hdf5::Shape(wanted.size(), 0), wanted, values.data());
    }
    return values;
  }

 private:
  const hdf5::File& file_;
  std::string group_;
  hsize_t rows_;
};

/// What a stylus did to an object.
struct ContactRows {
  std::vector<std::uint8_t> state;
  std::vector<std::uint8_t> slipping;
  std::vector<std::int32_t> nodes;
  std::vector<double> weights;
  std::vector<double> force;  ///< on the object, B; or on the stylus, W, when the object is alone
  std::vector<double> proxy;
  std::vector<double> offset;

  ContactRows() = default;
  ContactRows(const RowReader& reader, const std::string& path)
      : state(reader.read<std::uint8_t>(path + "/contact")),
        slipping(reader.read<std::uint8_t>(path + "/slipping")),
        nodes(reader.read<std::int32_t>(path + "/contact_nodes", 3)),
        weights(reader.read<double>(path + "/contact_weights", 3)),
        force(reader.read<double>(path + "/force", 3)),
        proxy(reader.read<double>(path + "/proxy", 3)),
        offset(reader.read<double>(path + "/offset", 3)) {}

  void check(int node_count, const std::string& path, const std::string& file) const {
    for (std::size_t k = 0; k < state.size(); ++k) {
      if (state[k] == 0) continue;
      for (std::size_t i = 0; i < 3; ++i) {
        if (state[k] <= 2 && nodes[at(k, 3) + i] >= 0 && nodes[at(k, 3) + i] < node_count) continue;
        throw Error(file, path + " touches a node that the model does not have",
                    "use the model that it was recorded with");
      }
    }
  }
};

struct StylusRows {
  std::vector<double> tip, proxy, force;
  std::vector<std::uint8_t> present;
  std::vector<std::int32_t> buttons, object;
};

struct FloorRows {
  std::vector<std::int32_t> node;
  std::vector<float> force;
  std::vector<std::size_t> first;  ///< of each step, and one more
};

struct ObjectRows {
  std::vector<double> position, orientation, velocity, angular_velocity;
  std::vector<ContactRows> contacts;  ///< per stylus
  FloorRows floor;
};

struct SettingsRows {
  std::vector<std::uint64_t> force_step;
  std::vector<Settings> settings;
};

FloorRows read_floor(const hdf5::File& file, const RowReader& reader, const std::string& path,
                     int node_count) {
  FloorRows rows;
  rows.first.assign(1, 0);
  if (!file.exists(path + "/count")) {
    rows.first.resize(reader.rows() + 1, 0);
    return rows;
  }
  rows.node = file.read<std::int32_t>(path + "/node", {0});
  rows.force = file.read<float>(path + "/force", {rows.node.size(), 3});
  for (const std::int32_t count : reader.read<std::int32_t>(path + "/count")) {
    const std::size_t next = rows.first.back() + static_cast<std::size_t>(std::max(count, 0));
    if (count < 0 || count > kMaxFloorContacts || next > rows.node.size()) {
      throw Error(file.name(), path + "/count does not fit the rows that are there",
                  "record it again");
    }
    rows.first.push_back(next);
  }
  for (const std::int32_t node : rows.node) {
    if (node >= 0 && node < node_count) continue;
    throw Error(file.name(), path + " touches a node that the model does not have",
                "use the model that it was recorded with");
  }
  return rows;
}

EngineKind engine_of(std::uint8_t number) {
  if (number == static_cast<std::uint8_t>(EngineKind::kCompressed)) return EngineKind::kCompressed;
  return number != 0 ? EngineKind::kDense : EngineKind::kModal;
}

SettingsRows read_settings(const hdf5::File& file, const SimulationConfig& config) {
  SettingsRows rows;
  if (!file.exists("/settings/force_step")) {  // an older trace
    rows.force_step = {0};
    rows.settings = {initial_settings(config)};
    return rows;
  }
  rows.force_step = file.read<std::uint64_t>("/settings/force_step", {0});
  const hsize_t count = rows.force_step.size();
  if (count == 0) throw Error(file.name(), "/settings has no row", "record it again");
  rows.settings.resize(count);
  const auto gravity = file.read<double>("/settings/gravity", {count, 3});
  for (std::size_t e = 0; e < count; ++e) rows.settings[e].gravity = vector_of(gravity, e);
  for (std::size_t i = 0; i < config.objects.size(); ++i) {
    const std::string group = trace::settings_path(i);
    const auto friction = file.read<double>(group + "/friction", {count, 2});
    const auto damping = file.read<double>(group + "/damping", {count, 2});
    const auto tether = file.read<double>(group + "/tether", {count, 2});
    const auto material = file.read<double>(group + "/material_damping", {count});
    const auto dense = file.read<std::uint8_t>(group + "/dense", {count});
    const auto loading = file.read<std::uint8_t>(group + "/inertial_loading", {count});
    for (std::size_t e = 0; e < count; ++e) {
      rows.settings[e].object[i] = {{friction[2 * e], friction[2 * e + 1]},
                                    {damping[2 * e], damping[2 * e + 1]},
                                    {tether[2 * e], tether[2 * e + 1]},
                                    material[e],
                                    engine_of(dense[e]),
                                    loading[e] != 0};
    }
  }
  return rows;
}

struct LateRows {
  std::vector<std::uint64_t> force_step;
  std::vector<LateForce> late;
  // Of the object, before the step, with all of them.
  std::vector<double> position, orientation, velocity, angular_momentum;
};

void check_late(const LateForce& late, const SimulationConfig& config, const std::string& file) {
  const auto within = [](int value, std::size_t count) {
    return value >= 0 && static_cast<std::size_t>(value) < count;
  };
  bool good = within(late.object, config.objects.size()) &&
              within(late.stylus, config.styluses.size()) && within(late.age, kMaxHorizon);
  for (const int node : late.point.nodes) {
    good =
        good && node >= 0 &&
        node <
            config.objects[static_cast<std::size_t>(late.object)].model->mesh.surface_node_count();
  }
  if (!good) {
    throw Error(file, "/late has a force on something that the model or the scene does not have",
                "use the scene and the model that it was recorded with");
  }
}

LateRows read_late(const hdf5::File& file, const SimulationConfig& config) {
  LateRows rows;
  if (!file.exists("/late/force_step")) return rows;  // an older trace
  const EventReader reader(
      file, "/late",
      {"/force_step", "/age", "/object", "/stylus", "/contact_nodes", "/contact_weights", "/force",
       "/arm", "/body_position", "/body_orientation", "/body_velocity", "/body_angular_momentum"});
  rows.force_step = reader.read<std::uint64_t>("/force_step");
  const hsize_t count = reader.rows();
  const auto age = reader.read<std::int32_t>("/age");
  const auto object = reader.read<std::int32_t>("/object");
  const auto stylus = reader.read<std::int32_t>("/stylus");
  const auto nodes = reader.read<std::int32_t>("/contact_nodes", 3);
  const auto weights = reader.read<double>("/contact_weights", 3);
  const auto force = reader.read<double>("/force", 3);
  const auto arm = reader.read<double>("/arm", 3);
  rows.position = reader.read<double>("/body_position", 3);
  rows.orientation = reader.read<double>("/body_orientation", 4);
  rows.velocity = reader.read<double>("/body_velocity", 3);
  rows.angular_momentum = reader.read<double>("/body_angular_momentum", 3);
  for (std::size_t e = 0; e < count; ++e) {
    LateForce late{object[e], stylus[e], age[e], {}, vector_of(force, e), vector_of(arm, e)};
    for (std::size_t i = 0; i < 3; ++i) {
      late.point.nodes[i] = nodes[at(e, 3) + i];
      late.point.weights[i] = weights[at(e, 3) + i];
    }
    check_late(late, config, file.name());
    rows.late.push_back(late);
  }
  return rows;
}

struct BridgedRows {
  std::vector<std::uint64_t> force_step;
  std::vector<std::int32_t> stylus;
  std::vector<BridgedForce> bridged;
};

BridgedRows read_bridged(const hdf5::File& file, const SimulationConfig& config) {
  BridgedRows rows;
  if (!file.exists("/bridged/force_step")) return rows;  // an older trace
  const EventReader reader(file, "/bridged",
                           {"/force_step", "/stylus", "/object", "/force", "/arm"});
  rows.force_step = reader.read<std::uint64_t>("/force_step");
  const hsize_t count = reader.rows();
  rows.stylus = reader.read<std::int32_t>("/stylus");
  const auto object = reader.read<std::int32_t>("/object");
  const auto force = reader.read<double>("/force", 3);
  const auto arm = reader.read<double>("/arm", 3);
  for (std::size_t e = 0; e < count; ++e) {
    const std::int32_t stylus = rows.stylus[e];
    if (stylus < 0 || stylus >= static_cast<std::int32_t>(config.styluses.size()) ||
        object[e] < -1 || object[e] >= static_cast<std::int32_t>(config.objects.size())) {
      throw Error(file.name(), "/bridged speaks of a stylus or an object that the scene lacks",
                  "use the scene that it was recorded with");
    }
    rows.bridged.push_back({vector_of(force, e), vector_of(arm, e), object[e]});
  }
  return rows;
}

}  // namespace

struct Recording::Data {
  SimulationConfig config;
  std::vector<RigidBody> bodies;
  double dt = 0.0;
  std::vector<std::uint64_t> force_step;
  std::vector<std::uint8_t> reset;
  std::vector<std::size_t> settings_of;  ///< row in `settings`, of each step
  SettingsRows settings;
  std::vector<std::size_t> last_reset;  ///< step of the recording, of each step
  LateRows late;
  std::vector<std::span<const LateForce>> late_of;  ///< in `late`, of each step
  BridgedRows bridged;
  std::vector<std::size_t> bridged_of;  ///< first row in `bridged`, of each step, and one more
  std::vector<StylusRows> styluses;
  std::vector<ObjectRows> objects;

  void read(const hdf5::File& file, const std::vector<std::string>& names);
  void read_objects(const hdf5::File& file, const RowReader& reader,
                    const std::vector<std::string>& names);
  void read_styluses(const hdf5::File& file, const RowReader& reader);
  void number_settings_and_resets();
  void number_late(const std::string& file);
  void number_bridged();
  RigidState before(std::size_t object, std::size_t k) const;
  void object_step(std::size_t object, std::size_t k, ObjectRecord& out, bool feels_spin) const;
  ContactRecord contact(const ContactRows& rows, std::size_t k, const RigidState& before) const;
};

TraceHeader read_trace_header(const std::filesystem::path& path) {
  const hdf5::File file = hdf5::File::open(path);
  if (file.read_string_attribute("/", "format") != "irdm-trace") {
    throw Error(path.string(), "is not a trace", "give a file that irdm-server --record has made");
  }
  if (file.read_integer_attribute("/", "version") != 1) {
    throw Error(path.string(), "is a trace of another version", "record it again");
  }
  TraceHeader header;
  header.scene = file.read_string_attribute("/", "scene");
  header.dt = file.read_double_attribute("/", "dt");
  header.stylus_count = 0;
  while (file.exists("/stylus/" + std::to_string(header.stylus_count))) ++header.stylus_count;
  header.objects.push_back({"", file.read_string_attribute("/", "model_file"),
                            file.read_string_attribute("/", "model_checksum")});
  return header;
}

std::vector<TraceObject> read_trace_objects(const std::filesystem::path& path,
                                            const std::vector<std::string>& names) {
  const hdf5::File file = hdf5::File::open(path);
  std::vector<TraceObject> objects;
  for (const std::string& name : names) {
    const std::string group = names.size() > 1 ? trace::object_path(true, name) : "/";
    objects.push_back({name, file.read_string_attribute(group, "model_file"),
                       file.read_string_attribute(group, "model_checksum")});
  }
  return objects;
}

void Recording::Data::read(const hdf5::File& file, const std::vector<std::string>& names) {
  const RowReader reader(file);
  dt = file.read_double_attribute("/", "dt");
  force_step = reader.read<std::uint64_t>("/step/force_step");
  reset = reader.read<std::uint8_t>("/step/reset");
  if (force_step.empty()) throw Error(file.name(), "holds no step", "record something");
  if (std::adjacent_find(force_step.begin(), force_step.end(), std::greater_equal<>()) !=
      force_step.end()) {
    throw Error(file.name(), "/step/force_step does not increase", "record it again");
  }
  settings = read_settings(file, config);
  late = read_late(file, config);
  bridged = read_bridged(file, config);
  read_styluses(file, reader);
  read_objects(file, reader, names);
  number_settings_and_resets();
  number_late(file.name());
  number_bridged();
}

void Recording::Data::read_styluses(const hdf5::File& file, const RowReader& reader) {
  for (std::size_t s = 0; s < config.styluses.size(); ++s) {
    const std::string path = trace::stylus_path(s);
    StylusRows rows{
        reader.read<double>(path + "/tip", 3),        reader.read<double>(path + "/proxy", 3),
        reader.read<double>(path + "/force", 3),      reader.read<std::uint8_t>(path + "/present"),
        reader.read<std::int32_t>(path + "/buttons"), {}};
    if (config.objects.size() > 1) rows.object = reader.read<std::int32_t>(path + "/object");
    for (const std::int32_t object : rows.object) {
      if (object < static_cast<std::int32_t>(config.objects.size())) continue;
      throw Error(file.name(), path + "/object is out of range", "record it again");
    }
    styluses.push_back(std::move(rows));
  }
}

void Recording::Data::read_objects(const hdf5::File& file, const RowReader& reader,
                                   const std::vector<std::string>& names) {
  const bool several = names.size() > 1;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const int node_count = config.objects[i].model->mesh.surface_node_count();
    const std::string group = trace::object_path(several, names[i]);
    ObjectRows rows{reader.read<double>(group + "/body_position", 3),
                    reader.read<double>(group + "/body_orientation", 4),
                    reader.read<double>(group + "/body_velocity", 3),
                    reader.read<double>(group + "/body_angular_velocity", 3),
                    {},
                    read_floor(file, reader, trace::floor_path(group), node_count)};
    for (std::size_t s = 0; s < config.styluses.size(); ++s) {
      const std::string path = (several ? group : "") + trace::stylus_path(s);
      rows.contacts.emplace_back(reader, path);
      rows.contacts.back().check(node_count, path, file.name());
    }
    objects.push_back(std::move(rows));
    bodies.emplace_back(config.objects[i].model->body, dt);
  }
}

void Recording::Data::number_settings_and_resets() {
  std::size_t row = 0;
  std::size_t last = 0;
  for (std::size_t k = 0; k < force_step.size(); ++k) {
    while (row + 1 < settings.force_step.size() && settings.force_step[row + 1] <= force_step[k]) {
      ++row;
    }
    settings_of.push_back(row);
    if (reset[k] != 0) last = k;
    last_reset.push_back(last);
  }
}

void Recording::Data::number_late(const std::string& file) {
  std::size_t row = 0;
  const std::size_t rows = late.force_step.size();
  for (const std::uint64_t step : force_step) {
    while (row < rows && late.force_step[row] < step) ++row;  // of a step that was lost
    std::size_t end = row;
    while (end < rows && late.force_step[end] == step) ++end;
    if (end - row > LateForces::kMost) {
      throw Error(file, "/late has more forces for a step than there can be", "record it again");
    }
    late_of.push_back(std::span(late.late).subspan(row, end - row));
    row = end;
  }
}

void Recording::Data::number_bridged() {
  std::size_t row = 0;
  for (const std::uint64_t step : force_step) {
    while (row < bridged.force_step.size() && bridged.force_step[row] < step) ++row;
    bridged_of.push_back(row);
  }
  while (row < bridged.force_step.size() && bridged.force_step[row] <= force_step.back()) ++row;
  bridged_of.push_back(row);
}

RigidState Recording::Data::before(std::size_t i, std::size_t k) const {
  const ObjectRows& rows = objects[i];
  RigidState state;
  Vector3 angular_velocity;
  if (k == 0 || reset[k] != 0) {
    const SimulationObject& start = config.objects[i];
    state.position = start.position;
    state.orientation = start.orientation.normalized();
    state.velocity = start.velocity;
    angular_velocity = start.angular_velocity;
  } else {
    const double* q = rows.orientation.data() + at(k - 1, 4);
    state.position = vector_of(rows.position, k - 1);
    state.orientation = Quaternion(q[0], q[1], q[2], q[3]);
    state.velocity = vector_of(rows.velocity, k - 1);
    angular_velocity = vector_of(rows.angular_velocity, k - 1);
  }
  state.angular_momentum = bodies[i].angular_momentum(state.orientation, angular_velocity);
  for (std::size_t e = 0; e < late_of[k].size(); ++e) {
    if (late_of[k][e].object != static_cast<int>(i)) continue;
    const auto row = static_cast<std::size_t>(&late_of[k][e] - late.late.data());
    const double* q = late.orientation.data() + at(row, 4);
    state.position = vector_of(late.position, row);
    state.orientation = Quaternion(q[0], q[1], q[2], q[3]);
    state.velocity = vector_of(late.velocity, row);
    state.angular_momentum = vector_of(late.angular_momentum, row);
  }
  return state;
}

ContactRecord Recording::Data::contact(const ContactRows& rows, std::size_t k,
                                       const RigidState& before) const {
  ContactRecord contact;
  contact.state = static_cast<ContactState>(rows.state[k]);
  if (contact.state == ContactState::kFree) return contact;
  contact.slipping = rows.slipping[k] != 0;
  for (std::size_t i = 0; i < 3; ++i) {
    contact.point.nodes[i] = rows.nodes[at(k, 3) + i];
    contact.point.weights[i] = rows.weights[at(k, 3) + i];
  }
  contact.force = vector_of(rows.force, k);
  if (objects.size() == 1) contact.force = -(before.orientation.conjugate() * contact.force);
  contact.proxy = vector_of(rows.proxy, k);
  contact.offset = vector_of(rows.offset, k);
  return contact;
}

void Recording::Data::object_step(std::size_t i, std::size_t k, ObjectRecord& out,
                                  bool feels_spin) const {
  const ObjectRows& rows = objects[i];
  const RigidState start = before(i, k);
  const double* q = rows.orientation.data() + at(k, 4);
  out.start = start;
  out.position = vector_of(rows.position, k);
  out.orientation = Quaternion(q[0], q[1], q[2], q[3]);
  out.velocity = vector_of(rows.velocity, k);
  out.angular_velocity = vector_of(rows.angular_velocity, k);
  out.spin = feels_spin ? bodies[i].mid_step_spin(start) : Vector3::Zero();
  out.contact.fill(ContactRecord{});
  for (std::size_t s = 0; s < rows.contacts.size(); ++s) {
    out.contact[s] = contact(rows.contacts[s], k, start);
  }
  out.floor_count = 0;
  out.floor_force.setZero();
  for (std::size_t r = rows.floor.first[k]; r < rows.floor.first[k + 1]; ++r) {
    FloorForce& force = out.floor[static_cast<std::size_t>(out.floor_count++)];
    force = {rows.floor.node[r],
             Eigen::Map<const Eigen::Vector3f>(rows.floor.force.data() + 3 * r)};
    out.floor_force += start.orientation * force.force.cast<double>();
  }
}

Recording::Recording(const std::filesystem::path& path, const SimulationConfig& config,
                     const std::vector<std::string>& names)
    : data_(std::make_unique<Data>()) {
  const std::lock_guard lock(hdf5::library_mutex());
  const hdf5::File file = hdf5::File::open(path);
  data_->config = config;
  data_->read(file, names);
}

Recording::Recording(Recording&&) noexcept = default;
Recording& Recording::operator=(Recording&&) noexcept = default;
Recording::~Recording() = default;

std::size_t Recording::steps() const noexcept {
  return data_->force_step.size();
}

std::uint64_t Recording::lost_steps() const noexcept {
  return data_->force_step.back() - data_->force_step.front() + 1 - data_->force_step.size();
}

void Recording::step(std::size_t k, StepRecord& record) const {
  const Data& data = *data_;
  record.force_step = k;
  record.time = static_cast<double>(k + 1) * data.dt;
  record.reset = data.reset[k] != 0;
  record.reset_step = data.last_reset[k];
  record.settings_change = static_cast<std::uint32_t>(data.settings_of[k] + 1);
  record.settings = data.settings.settings[data.settings_of[k]];
  record.object_count = static_cast<int>(data.objects.size());
  record.stylus_count = static_cast<int>(data.styluses.size());
  const std::span<const LateForce> late = data.late_of[k];
  record.late.count = late.size();
  std::copy(late.begin(), late.end(), record.late.force.begin());
  for (std::size_t i = 0; i < data.objects.size(); ++i) {
    data.object_step(i, k, record.object[i], record.settings.object[i].inertial_loading);
  }
  for (std::size_t s = 0; s < data.styluses.size(); ++s) {
    const StylusRows& rows = data.styluses[s];
    StylusRecord& stylus = record.stylus[s];
    stylus.present = rows.present[k] != 0;
    stylus.buttons = static_cast<std::uint32_t>(rows.buttons[k]);
    stylus.tip = vector_of(rows.tip, k);
    stylus.proxy = vector_of(rows.proxy, k);
    stylus.force = vector_of(rows.force, k);
    stylus.bridged.reset();
    const bool free = data.objects.size() == 1 && data.objects[0].contacts[s].state[k] == 0;
    stylus.object = rows.object.empty() ? (free ? -1 : 0) : rows.object[k];
    stylus.contact = ContactState::kFree;
    if (stylus.object >= 0) {
      const auto i = static_cast<std::size_t>(stylus.object);
      stylus.contact = record.object[i].contact[s].state;
    }
  }
  for (std::size_t row = data.bridged_of[k]; row < data.bridged_of[k + 1]; ++row) {
    record.stylus[static_cast<std::size_t>(data.bridged.stylus[row])].bridged =
        data.bridged.bridged[row];
  }
}

}  // namespace irdm
