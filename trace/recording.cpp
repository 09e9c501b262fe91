#include "trace/recording.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <mutex>
#include <string>

#include "common/error.hpp"
#include "common/hdf5/handle.hpp"
#include "common/motion/rigid_body.hpp"
#include "trace/body_contact_rows.hpp"
#include "trace/trace_layout.hpp"
#include "trace/trace_rows.hpp"

namespace irdm::trace {
namespace {

constexpr double kRounding = 1e-6;

}  // namespace

void TraceCheck::refuse(const std::string& set, std::size_t row, const std::string& what) const {
  throw Error(file_, set + " of step " + std::to_string(steps_[row]) + " " + what,
              "record it again");
}

void TraceCheck::number(const std::string& set, std::size_t row, double value,
                        const Range& range) const {
  if (range.contains(value)) return;
  refuse(set, row, outside_text(range, value));
}

void TraceCheck::numbers(const std::string& set, std::span<const double> values, std::size_t width,
                         const Range& range) const {
  for (std::size_t i = 0; i < values.size(); ++i) number(set, i / width, values[i], range);
}

void TraceCheck::orientations(const std::string& set, std::span<const double> values) const {
  for (std::size_t row = 0; 4 * row < values.size(); ++row) {
    double square = 0.0;
    for (const double part : values.subspan(4 * row, 4)) square += part * part;
    if (std::abs(square - 1.0) <= kRounding) continue;
    refuse(set, row, "is no quaternion of length 1");
  }
}

void TraceCheck::directions(const std::string& set, std::span<const double> values) const {
  for (std::size_t row = 0; 3 * row < values.size(); ++row) {
    double square = 0.0;
    for (const double part : values.subspan(3 * row, 3)) square += part * part;
    if (!(std::abs(square - 1.0) <= kRounding)) refuse(set, row, "is no direction of length 1");
  }
}

void TraceCheck::flags(const std::string& set, std::span<const std::uint8_t> values,
                       std::size_t width, std::uint8_t highest) const {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i] <= highest) continue;
    refuse(set, i / width,
           "is " + std::to_string(values[i]) + ", not from 0 to " + std::to_string(highest));
  }
}

void TraceCheck::weights(const std::string& set, std::span<const double> values,
                         std::size_t row) const {
  double sum = 0.0;
  bool good = true;
  for (const double weight : values.subspan(3 * row, 3)) {
    good = good && between(-kRounding, 1.0 + kRounding).contains(weight);
    sum += weight;
  }
  if (!good || !(std::abs(sum - 1.0) <= kRounding)) refuse(set, row, "are no barycentric weights");
}

}  // namespace irdm::trace

namespace irdm {

struct Recording::Data {
  SimulationConfig config;
  std::vector<RigidBody> bodies;
  double dt = 0.0;
  std::vector<std::uint64_t> force_step;
  std::vector<std::uint8_t> reset;
  std::vector<std::uint8_t> asleep;      ///< of each step and object; empty: never
  std::vector<std::size_t> settings_of;  ///< row in `settings`, of each step
  trace::SettingsRows settings;
  std::vector<std::size_t> last_reset;  ///< step of the recording, of each step
  trace::LateRows late;
  std::vector<std::span<const LateForce>> late_of;  ///< in `late`, of each step
  trace::BridgedRows bridged;
  std::vector<std::size_t> bridged_of;  ///< first row in `bridged`, of each step, and one more
  trace::BodyContactRows touching;
  /// In `touching`, of each step.
  std::vector<std::span<const BodyContactRecord>> touching_of;
  std::vector<trace::StylusRows> styluses;
  std::vector<trace::ObjectRows> objects;

  void read(const hdf5::File& file, const std::vector<std::string>& names, std::size_t most);
  void read_objects(const hdf5::File& file, const trace::RowReader& reader,
                    const trace::TraceCheck& check, const std::vector<std::string>& names);
  void read_styluses(const hdf5::File& file, const trace::RowReader& reader,
                     const trace::TraceCheck& check);
  void number_settings_and_resets();
  void number_late(const std::string& file);
  void number_bridged();
  void number_touching(const std::string& file);
  RigidState before(std::size_t object, std::size_t k) const;
  void object_step(std::size_t object, std::size_t k, ObjectRecord& out,
                   bool has_inertial_loading) const;
  void tool(std::size_t stylus, std::size_t k, StylusRecord& out) const;
  ContactRecord contact(const trace::ContactRows& rows, std::size_t k,
                        const Quaternion& halfway) const;
};

void Recording::Data::read(const hdf5::File& file, const std::vector<std::string>& names,
                           std::size_t most) {
  const trace::RowReader reader(file, most);
  dt = trace::read_dt(file);
  force_step = reader.read<std::uint64_t>("/step/force_step");
  reset = reader.read<std::uint8_t>("/step/reset");
  if (file.exists(trace::kAsleep)) {
    asleep = reader.read<std::uint8_t>(trace::kAsleep, config.objects.size());
  }
  if (force_step.empty()) throw Error(file.name(), "holds no step", "record something");
  if (std::adjacent_find(force_step.begin(), force_step.end(), std::greater_equal<>()) !=
      force_step.end()) {
    throw Error(file.name(), "/step/force_step does not increase", "record it again");
  }
  const trace::TraceCheck check(file.name(), force_step);
  check.numbers("/step/time", reader.read<double>("/step/time"), 1);
  check.flags("/step/reset", reset);
  check.flags(trace::kAsleep, asleep, config.objects.size());
  settings = trace::read_settings(file, config, force_step.back());
  late = trace::read_late(file, config, force_step.back());
  bridged = trace::read_bridged(file, config, force_step.back());
  touching = trace::read_body_contacts(file, config, force_step.back());
  read_styluses(file, reader, check);
  read_objects(file, reader, check, names);
  number_settings_and_resets();
  number_late(file.name());
  number_bridged();
  number_touching(file.name());
}

void Recording::Data::read_styluses(const hdf5::File& file, const trace::RowReader& reader,
                                    const trace::TraceCheck& check) {
  for (std::size_t s = 0; s < config.styluses.size(); ++s) {
    const std::string path = trace::stylus_path(s);
    trace::StylusRows rows{
        reader.read<double>(path + "/tip", 3),        reader.read<double>(path + "/proxy", 3),
        reader.read<double>(path + "/force", 3),      reader.read<std::uint8_t>(path + "/present"),
        reader.read<std::int32_t>(path + "/buttons"), {}};
    check.flags(path + "/present", rows.present);
    check.numbers(path + "/tip", rows.tip, 3);
    check.numbers(path + "/proxy", rows.proxy, 3);
    check.numbers(path + "/force", rows.force, 3);
    if (config.styluses[s].tool) {
      rows.orientation = reader.read<double>(path + "/orientation", 4);
      rows.torque = reader.read<double>(path + "/torque", 3);
      check.orientations(path + "/orientation", rows.orientation);
      check.numbers(path + "/torque", rows.torque, 3);
    }
    if (config.objects.size() > 1) rows.object = reader.read<std::int32_t>(path + "/object");
    for (const std::int32_t object : rows.object) {
      if (object < static_cast<std::int32_t>(config.objects.size())) continue;
      throw Error(file.name(), path + "/object is out of range", "record it again");
    }
    styluses.push_back(std::move(rows));
  }
}

void Recording::Data::read_objects(const hdf5::File& file, const trace::RowReader& reader,
                                   const trace::TraceCheck& check,
                                   const std::vector<std::string>& names) {
  const bool several = names.size() > 1;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const int node_count = config.objects[i].model->mesh.surface_node_count();
    const std::string group = trace::object_path(several, names[i]);
    trace::ObjectRows rows{
        reader.read<double>(group + "/body_position", 3),
        reader.read<double>(group + "/body_orientation", 4),
        reader.read<double>(group + "/body_velocity", 3),
        reader.read<double>(group + "/body_angular_velocity", 3),
        {},
        trace::read_floor(file, reader, check, trace::floor_path(group), node_count)};
    check.numbers(group + "/body_position", rows.position, 3);
    check.orientations(group + "/body_orientation", rows.orientation);
    check.numbers(group + "/body_velocity", rows.velocity, 3);
    check.numbers(group + "/body_angular_velocity", rows.angular_velocity, 3);
    for (std::size_t s = 0; s < config.styluses.size(); ++s) {
      const std::string path = (several ? group : "") + trace::stylus_path(s);
      rows.contacts.emplace_back(file, reader, check, path, node_count);
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

void Recording::Data::number_touching(const std::string& file) {
  std::size_t row = 0;
  const std::vector<std::uint64_t>& of = touching.force_step;
  for (const std::uint64_t step : force_step) {
    while (row < of.size() && of[row] < step) ++row;  // of a step that was lost
    std::size_t end = row;
    while (end < of.size() && of[end] == step) ++end;
    if (end - row > kMaxBodyContacts) {
      throw Error(file,
                  "/body_contact has " + std::to_string(end - row) + " contacts in step " +
                      std::to_string(step) + ", and " + std::to_string(kMaxBodyContacts) +
                      " are the most",
                  "record it again");
    }
    touching_of.push_back(std::span(touching.contact).subspan(row, end - row));
    row = end;
  }
}

RigidState Recording::Data::before(std::size_t i, std::size_t k) const {
  const trace::ObjectRows& rows = objects[i];
  RigidState state;
  Vector3 angular_velocity;
  if (k == 0 || reset[k] != 0) {
    const SimulationObject& start = config.objects[i];
    state.position = start.position;
    state.orientation = start.orientation.normalized();
    state.velocity = start.velocity;
    angular_velocity = start.angular_velocity;
  } else {
    const double* q = rows.orientation.data() + 4 * (k - 1);
    state.position = trace::vector_of(rows.position, k - 1);
    state.orientation = Quaternion(q[0], q[1], q[2], q[3]);
    state.velocity = trace::vector_of(rows.velocity, k - 1);
    angular_velocity = trace::vector_of(rows.angular_velocity, k - 1);
  }
  state.angular_momentum = bodies[i].angular_momentum(state.orientation, angular_velocity);
  for (std::size_t e = 0; e < late_of[k].size(); ++e) {
    if (late_of[k][e].object != static_cast<int>(i)) continue;
    const auto row = static_cast<std::size_t>(&late_of[k][e] - late.late.data());
    const double* q = late.orientation.data() + 4 * row;
    state.position = trace::vector_of(late.position, row);
    state.orientation = Quaternion(q[0], q[1], q[2], q[3]);
    state.velocity = trace::vector_of(late.velocity, row);
    state.angular_momentum = trace::vector_of(late.angular_momentum, row);
  }
  return state;
}

ContactRecord Recording::Data::contact(const trace::ContactRows& rows, std::size_t k,
                                       const Quaternion& halfway) const {
  ContactRecord contact;
  contact.state = static_cast<ContactState>(rows.state[k]);
  if (contact.state == ContactState::kFree) return contact;
  contact.slipping = rows.slipping[k] != 0;
  for (std::size_t i = 0; i < 3; ++i) {
    contact.point.nodes[i] = rows.nodes[3 * k + i];
    contact.point.weights[i] = rows.weights[3 * k + i];
  }
  contact.force = trace::vector_of(rows.force, k);
  if (objects.size() == 1) contact.force = -(halfway.conjugate() * contact.force);
  contact.proxy = trace::vector_of(rows.proxy, k);
  contact.offset = trace::vector_of(rows.offset, k);
  contact.arm_shift = trace::vector_of(rows.arm_shift, k);
  return contact;
}

void Recording::Data::object_step(std::size_t i, std::size_t k, ObjectRecord& out,
                                  bool has_inertial_loading) const {
  const trace::ObjectRows& rows = objects[i];
  out.asleep = !asleep.empty() && asleep[objects.size() * k + i] != 0;
  RigidState start = before(i, k);
  if (out.asleep) start.velocity = start.angular_momentum = Vector3::Zero();
  const double* q = rows.orientation.data() + 4 * k;
  out.start = start;
  out.halfway = bodies[i].mid_step_orientation(start);
  out.position = trace::vector_of(rows.position, k);
  out.orientation = Quaternion(q[0], q[1], q[2], q[3]);
  out.velocity = trace::vector_of(rows.velocity, k);
  out.angular_velocity = trace::vector_of(rows.angular_velocity, k);
  out.spin = has_inertial_loading ? bodies[i].mid_step_spin(start) : Vector3::Zero();
  out.contact.fill(ContactRecord{});
  for (std::size_t s = 0; s < rows.contacts.size(); ++s) {
    out.contact[s] = contact(rows.contacts[s], k, out.halfway);
    if (objects.size() > 1 || out.contact[s].state == ContactState::kFree) continue;
    // The recorded force on the stylus has those of the ball's own contacts in it.
    for (const BodyContactRecord& own : touching_of[k]) {
      if (stylus_of_ball(config, own.other) != static_cast<int>(s)) continue;
      out.contact[s].force -= out.halfway.conjugate() * own.force;
    }
  }
  out.floor_count = 0;
  out.floor_force.setZero();
  for (std::size_t r = rows.floor.first[k]; r < rows.floor.first[k + 1]; ++r) {
    FloorForce& force = out.floor[static_cast<std::size_t>(out.floor_count++)];
    force = {rows.floor.node[r],
             Eigen::Map<const Eigen::Vector3f>(rows.floor.force.data() + 3 * r)};
    out.floor_force += out.halfway * force.force.cast<double>();
  }
}

void Recording::Data::tool(std::size_t s, std::size_t k, StylusRecord& stylus) const {
  const std::optional<ToolCoupling>& tool = config.styluses[s].tool;
  stylus.tool = tool ? tool->object : -1;
  stylus.orientation.setIdentity();
  stylus.torque.setZero();
  if (!tool) return;
  const double* q = styluses[s].orientation.data() + 4 * k;
  stylus.orientation = Quaternion(q[0], q[1], q[2], q[3]);
  stylus.torque = trace::vector_of(styluses[s].torque, k);
}

Recording::Recording(const std::filesystem::path& path, const SimulationConfig& config,
                     const std::vector<std::string>& names, std::size_t most)
    : data_(std::make_unique<Data>()) {
  const std::lock_guard lock(hdf5::library_mutex());
  const hdf5::File file = hdf5::File::open(path);
  data_->config = config;
  data_->read(file, names, most);
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
  const std::span<const BodyContactRecord> touching = data.touching_of[k];
  record.body_contact.assign(touching.begin(), touching.end());
  for (std::size_t i = 0; i < data.objects.size(); ++i) {
    data.object_step(i, k, record.object[i], record.settings.object[i].inertial_loading);
  }
  for (std::size_t s = 0; s < data.styluses.size(); ++s) {
    const trace::StylusRows& rows = data.styluses[s];
    StylusRecord& stylus = record.stylus[s];
    stylus.present = rows.present[k] != 0;
    stylus.buttons = static_cast<std::uint32_t>(rows.buttons[k]);
    stylus.tip = trace::vector_of(rows.tip, k);
    stylus.proxy = trace::vector_of(rows.proxy, k);
    stylus.force = trace::vector_of(rows.force, k);
    stylus.bridged.reset();
    data.tool(s, k, stylus);
    const bool free = data.objects.size() == 1 && data.objects[0].contacts[s].state[k] == 0;
    stylus.object = rows.object.empty() ? (free ? -1 : 0) : rows.object[k];
    stylus.contact = ContactState::kFree;
    const bool pushes = data.config.styluses[s].has_ball() && !stylus.force.isZero(0.0);
    if (pushes && data.objects.size() == 1) stylus.object = 0;
    if (stylus.object >= 0) {
      const auto i = static_cast<std::size_t>(stylus.object);
      stylus.contact = record.object[i].contact[s].state;
      // Contacts of a ball are those of a body, until it takes hold.
      const bool held = stylus.contact != ContactState::kFree;
      if (pushes && !held) stylus.contact = ContactState::kTouching;
    }
  }
  for (std::size_t row = data.bridged_of[k]; row < data.bridged_of[k + 1]; ++row) {
    record.stylus[static_cast<std::size_t>(data.bridged.stylus[row])].bridged =
        data.bridged.bridged[row];
  }
}

}  // namespace irdm
