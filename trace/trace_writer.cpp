#include "trace/trace_writer.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "common/contact/contact_model.hpp"
#include "common/error.hpp"
#include "trace/trace_layout.hpp"

namespace irdm {

using trace::floor_path;
using trace::settings_path;
using trace::stylus_path;

namespace {

constexpr hsize_t kChunkRows = 512;

void put(double* row, const Vector3& v) {
  Eigen::Map<Vector3>(row, 3) = v;
}

}  // namespace

template <typename T>
void TraceWriter::create(const std::string& path, const hdf5::Shape& row) {
  file_.create_growing<T>(path, row, kChunkRows);
  const std::string unit = trace::unit_of(path);
  if (!unit.empty()) file_.write_attribute(path, "unit", unit);
}

TraceWriter::TraceWriter(const std::filesystem::path& path, const TraceHeader& header)
    : file_(hdf5::File::create_for_swmr(path)),
      objects_(header.objects),
      stylus_count_(header.stylus_count),
      tools_(header.tools),
      floor_(header.floor),
      bodies_(header.bodies),
      sleep_(header.sleep) {
  try {
    write_header(header);
    create_datasets();
    file_.begin_swmr();
  } catch (const Error&) {
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
    throw;
  }
}

void TraceWriter::write_header(const TraceHeader& header) {
  file_.write_attribute("/", "format", std::string("irdm-trace"));
  file_.write_attribute("/", "version", trace::kVersion);
  file_.write_attribute("/", "created_by", std::string("irdm ") + IRDM_VERSION);
  file_.write_attribute("/", "model_file", header.objects.front().model_file);
  file_.write_attribute("/", "model_checksum", header.objects.front().model_checksum);
  file_.write_attribute("/", "scene", header.scene);
  file_.write_attribute("/", "dt", header.dt);
  file_.write_attribute("/", "units", std::string("dt: s"));
}

void TraceWriter::create_datasets() {
  file_.write<std::uint64_t>(trace::kCommitted, {1}, &rows_);
  create<double>("/step/time", {});
  create<std::uint64_t>("/step/force_step", {});
  create<std::uint8_t>("/step/reset", {});
  if (sleep_) {
    create<std::uint8_t>(trace::kAsleep, several() ? hdf5::Shape{objects_.size()} : hdf5::Shape{});
  }
  create_settings();
  create_late();
  create_bridged();
  if (bodies_) create_body_contacts();
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    const std::string group = object_path(i);
    create_object(group);
    if (!several()) continue;
    file_.write_attribute(group, "model_file", objects_[i].model_file);
    file_.write_attribute(group, "model_checksum", objects_[i].model_checksum);
    for (std::size_t s = 0; s < static_cast<std::size_t>(stylus_count_); ++s) {
      create<double>(group + stylus_path(s) + "/proxy", {3});
      create<double>(group + stylus_path(s) + "/force", {3});
      create_contact(group + stylus_path(s));
    }
  }
  for (std::size_t s = 0; s < static_cast<std::size_t>(stylus_count_); ++s) {
    const std::string path = stylus_path(s);
    for (const char* name : {"/tip", "/proxy", "/force", "/applied_force"}) {
      create<double>(path + name, {3});
    }
    create_contact(path);
    create<std::uint8_t>(path + "/present", {});
    create<std::int32_t>(path + "/buttons", {});
    if (several()) create<std::int32_t>(path + "/object", {});
  }
  for (const int s : tools_) {
    const std::string path = stylus_path(static_cast<std::size_t>(s));
    create<double>(path + "/orientation", {4});
    create<double>(path + "/torque", {3});
  }
}

// One row for the first step and one for every change.
void TraceWriter::create_settings() {
  create<std::uint64_t>("/settings/force_step", {});
  create<double>("/settings/gravity", {3});
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    const std::string group = settings_path(i);
    for (const char* name : {"/friction", "/damping", "/tether"}) {
      create<double>(group + name, {2});
    }
    create<double>(group + "/material_damping", {});
    create<std::uint8_t>(group + "/inertial_loading", {});
  }
}

void TraceWriter::append_settings(std::span<const StepRecord> records) {
  for (const StepRecord& record : records) {
    if (settings_change_ == record.settings_change) continue;
    settings_change_ = record.settings_change;
    const Settings& settings = record.settings;
    file_.append<std::uint64_t>("/settings/force_step", 1, &record.force_step);
    file_.append<double>("/settings/gravity", 1, settings.gravity.data());
    for (std::size_t i = 0; i < objects_.size(); ++i) {
      const std::string group = settings_path(i);
      const ObjectSettings& object = settings.object[i];
      const auto pair = [&](const char* name, double first, double second) {
        const std::array<double, 2> values{first, second};
        file_.append<double>(group + name, 1, values.data());
      };
      pair("/friction", object.friction.static_, object.friction.kinetic);
      pair("/damping", object.damping.linear, object.damping.angular);
      pair("/tether", object.tether.stiffness, object.tether.angular_stiffness);
      file_.append<double>(group + "/material_damping", 1, &object.material_damping);
      const std::uint8_t loading = object.inertial_loading ? 1 : 0;
      file_.append<std::uint8_t>(group + "/inertial_loading", 1, &loading);
    }
  }
}

// One row for every force that was entered late.
void TraceWriter::create_late() {
  create<std::uint64_t>("/late/force_step", {});
  for (const char* name : {"/late/age", "/late/object", "/late/stylus"}) {
    create<std::int32_t>(name, {});
  }
  create<std::int32_t>("/late/contact_nodes", {3});
  for (const char* name :
       {"/late/contact_weights", "/late/force", "/late/arm", "/late/body_position",
        "/late/body_velocity", "/late/body_angular_momentum"}) {
    create<double>(name, {3});
  }
  create<double>("/late/body_orientation", {4});
}

void TraceWriter::append_late(std::span<const StepRecord> records) {
  for (const StepRecord& record : records) {
    for (const LateForce& late : record.late.view()) {
      file_.append<std::uint64_t>("/late/force_step", 1, &record.force_step);
      file_.append<std::int32_t>("/late/age", 1, &late.age);
      file_.append<std::int32_t>("/late/object", 1, &late.object);
      file_.append<std::int32_t>("/late/stylus", 1, &late.stylus);
      file_.append<std::int32_t>("/late/contact_nodes", 1, late.point.nodes.data());
      file_.append<double>("/late/contact_weights", 1, late.point.weights.data());
      file_.append<double>("/late/force", 1, late.force.data());
      file_.append<double>("/late/arm", 1, late.arm.data());
      const RigidState& body = record.object[static_cast<std::size_t>(late.object)].start;
      const Quaternion& Q = body.orientation;
      const std::array<double, 4> wxyz{Q.w(), Q.x(), Q.y(), Q.z()};
      file_.append<double>("/late/body_position", 1, body.position.data());
      file_.append<double>("/late/body_orientation", 1, wxyz.data());
      file_.append<double>("/late/body_velocity", 1, body.velocity.data());
      file_.append<double>("/late/body_angular_momentum", 1, body.angular_momentum.data());
    }
  }
}

void TraceWriter::correct_applied(std::span<const StepRecord> records) {
  std::uint64_t row = rows_;
  for (const StepRecord& record : records) {
    for (const LateForce& late : record.late.view()) {
      const auto own = std::find_if(recent_.begin(), recent_.end(), [&](const RecentStep& step) {
        return step.force_step + 1 + static_cast<std::uint64_t>(late.age) == record.force_step;
      });
      if (own == recent_.end()) continue;  // that step was lost
      const auto s = static_cast<std::size_t>(late.stylus);
      own->applied[s] -= own->halfway[static_cast<std::size_t>(late.object)] * late.force;
      file_.write_slab<double>(stylus_path(s) + "/applied_force", {own->row, 0}, {1, 3},
                               own->applied[s].data());
    }
    RecentStep& step = recent_.emplace_back();
    step.force_step = record.force_step;
    step.row = row++;
    for (std::size_t i = 0; i < objects_.size(); ++i) step.halfway[i] = record.object[i].halfway;
    for (std::size_t s = 0; s < static_cast<std::size_t>(stylus_count_); ++s) {
      step.applied[s] = record.stylus[s].force;
    }
    if (recent_.size() > static_cast<std::size_t>(kMaxHorizon)) recent_.pop_front();
  }
}

// One row for every step in which a bridge solved the contact of a stylus.
void TraceWriter::create_bridged() {
  create<std::uint64_t>("/bridged/force_step", {});
  create<std::int32_t>("/bridged/stylus", {});
  create<std::int32_t>("/bridged/object", {});
  create<double>("/bridged/force", {3});
  create<double>("/bridged/arm", {3});
  create<double>("/bridged/share", {});
}

void TraceWriter::append_bridged(std::span<const StepRecord> records) {
  std::vector<std::uint64_t> steps;
  std::vector<std::int32_t> styluses;
  std::vector<std::int32_t> objects;
  std::vector<double> forces;
  std::vector<double> arms;
  std::vector<double> shares;
  for (const StepRecord& r : records) {
    for (std::size_t s = 0; s < static_cast<std::size_t>(stylus_count_); ++s) {
      const std::optional<BridgedForce>& bridged = r.stylus[s].bridged;
      if (!bridged) continue;
      steps.push_back(r.force_step);
      styluses.push_back(static_cast<std::int32_t>(s));
      objects.push_back(bridged->object);
      forces.insert(forces.end(), bridged->force.begin(), bridged->force.end());
      arms.insert(arms.end(), bridged->arm.begin(), bridged->arm.end());
      shares.push_back(bridged->share.value_or(1.0));
    }
  }
  if (steps.empty()) return;
  file_.append<std::uint64_t>("/bridged/force_step", steps.size(), steps.data());
  file_.append<std::int32_t>("/bridged/stylus", steps.size(), styluses.data());
  file_.append<std::int32_t>("/bridged/object", steps.size(), objects.data());
  file_.append<double>("/bridged/force", steps.size(), forces.data());
  file_.append<double>("/bridged/arm", steps.size(), arms.data());
  file_.append<double>("/bridged/share", steps.size(), shares.data());
}

// One row for every contact of every step.
void TraceWriter::create_body_contacts() {
  create<std::uint64_t>("/body_contact/force_step", {});
  for (const char* name : {"/body_contact/object", "/body_contact/other", "/body_contact/sample",
                           "/body_contact/triangle"}) {
    create<std::int32_t>(name, {});
  }
  create<std::uint8_t>("/body_contact/slipping", {});
  for (const char* name : {"/body_contact/weights", "/body_contact/force", "/body_contact/position",
                           "/body_contact/normal", "/body_contact/slip"}) {
    create<double>(name, {3});
  }
  create<double>("/body_contact/area", {});
}

void TraceWriter::append_body_contacts(std::span<const StepRecord> records) {
  std::vector<std::uint64_t> steps;
  std::vector<BodyContactRecord> contacts;
  for (const StepRecord& r : records) {
    steps.insert(steps.end(), r.body_contacts().size(), r.force_step);
    contacts.insert(contacts.end(), r.body_contacts().begin(), r.body_contacts().end());
  }
  if (steps.empty()) return;
  const auto rows = [&]<typename T>(const char* name, std::size_t width, T /*zero*/,
                                    const auto& fill) {
    std::vector<T> values(contacts.size() * width);
    for (std::size_t i = 0; i < contacts.size(); ++i) fill(contacts[i], values.data() + i * width);
    file_.append<T>(name, contacts.size(), values.data());
  };
  const auto integers = [&](const char* name, int BodyContactRecord::*member) {
    rows(name, 1, std::int32_t{0},
         [&](const BodyContactRecord& c, std::int32_t* row) { *row = c.*member; });
  };
  const auto vectors = [&](const char* name, Vector3 BodyContactRecord::*member) {
    rows(name, 3, 0.0, [&](const BodyContactRecord& c, double* row) { put(row, c.*member); });
  };
  file_.append<std::uint64_t>("/body_contact/force_step", steps.size(), steps.data());
  integers("/body_contact/object", &BodyContactRecord::object);
  integers("/body_contact/other", &BodyContactRecord::other);
  integers("/body_contact/sample", &BodyContactRecord::sample);
  integers("/body_contact/triangle", &BodyContactRecord::triangle);
  rows("/body_contact/slipping", 1, std::uint8_t{0},
       [](const BodyContactRecord& c, std::uint8_t* row) { *row = c.slipping ? 1 : 0; });
  rows("/body_contact/weights", 3, 0.0, [](const BodyContactRecord& c, double* row) {
    std::copy(c.weights.begin(), c.weights.end(), row);
  });
  vectors("/body_contact/force", &BodyContactRecord::force);
  vectors("/body_contact/position", &BodyContactRecord::position);
  vectors("/body_contact/normal", &BodyContactRecord::normal);
  vectors("/body_contact/slip", &BodyContactRecord::slip);
  rows("/body_contact/area", 1, 0.0,
       [](const BodyContactRecord& c, double* row) { *row = c.area; });
}

std::string TraceWriter::object_path(std::size_t object) const {
  return trace::object_path(several(), objects_[object].name);
}

void TraceWriter::create_object(const std::string& group) {
  create<double>(group + "/body_position", {3});
  create<double>(group + "/body_orientation", {4});
  create<double>(group + "/body_velocity", {3});
  create<double>(group + "/body_angular_velocity", {3});
  create<double>(group + "/residual", {});
  create<std::int32_t>(group + "/sweeps", {});
  if (!floor_) return;
  const std::string floor = floor_path(group);
  create<std::int32_t>(floor + "/count", {});
  create<std::int32_t>(floor + "/node", {});
  create<float>(floor + "/force", {3});
}

void TraceWriter::create_contact(const std::string& group) {
  create<double>(group + "/contact_weights", {3});
  create<double>(group + "/offset", {3});
  create<double>(group + "/arm_shift", {3});
  create<std::uint8_t>(group + "/contact", {});
  create<std::uint8_t>(group + "/slipping", {});
  create<std::int32_t>(group + "/contact_nodes", {3});
}

template <typename T, typename Fill>
void TraceWriter::append_rows(const std::string& dataset, std::size_t width,
                              std::span<const StepRecord> records, const Fill& fill) {
  std::vector<T> values(records.size() * width);
  for (std::size_t k = 0; k < records.size(); ++k) fill(records[k], values.data() + k * width);
  file_.append<T>(dataset, records.size(), values.data());
}

// The count goes to the disk after what it counts.
void TraceWriter::flush() {
  file_.require_in_place();
  file_.flush();
  file_.write_slab<std::uint64_t>(trace::kCommitted, {0}, {1}, &rows_);
  file_.flush();
}

void TraceWriter::close() {
  flush();
  file_.close();
}

void TraceWriter::append(std::span<const StepRecord> records) {
  if (records.empty()) return;
  file_.require_in_place();
  append_rows<std::uint64_t>("/step/force_step", 1, records,
                             [](const StepRecord& r, std::uint64_t* row) { *row = r.force_step; });
  append_rows<std::uint8_t>("/step/reset", 1, records,
                            [](const StepRecord& r, std::uint8_t* row) { *row = r.reset ? 1 : 0; });
  append_rows<double>("/step/time", 1, records,
                      [](const StepRecord& r, double* row) { *row = r.time; });
  if (sleep_) {
    append_rows<std::uint8_t>(trace::kAsleep, objects_.size(), records,
                              [&](const StepRecord& r, std::uint8_t* row) {
                                for (std::size_t i = 0; i < objects_.size(); ++i) {
                                  row[i] = r.object[i].asleep ? 1 : 0;
                                }
                              });
  }
  append_settings(records);
  append_late(records);
  append_bridged(records);
  if (bodies_) append_body_contacts(records);
  for (std::size_t i = 0; i < objects_.size(); ++i) append_object(records, i);
  for (std::size_t s = 0; s < static_cast<std::size_t>(stylus_count_); ++s) {
    append_stylus(records, s);
  }
  for (const int s : tools_) append_tool(records, static_cast<std::size_t>(s));
  correct_applied(records);
  rows_ += records.size();
}

void TraceWriter::append_object(std::span<const StepRecord> records, std::size_t i) {
  const std::string group = object_path(i);
  const auto vectors = [&](const char* name, const auto& member) {
    append_rows<double>(group + name, 3, records,
                        [&](const StepRecord& r, double* row) { put(row, r.object[i].*member); });
  };
  vectors("/body_position", &ObjectRecord::position);
  vectors("/body_velocity", &ObjectRecord::velocity);
  vectors("/body_angular_velocity", &ObjectRecord::angular_velocity);
  append_rows<double>(group + "/body_orientation", 4, records,
                      [&](const StepRecord& r, double* row) {
                        row[0] = r.object[i].orientation.w();
                        put(row + 1, r.object[i].orientation.vec());
                      });
  append_rows<double>(group + "/residual", 1, records,
                      [&](const StepRecord& r, double* row) { *row = r.object[i].residual; });
  append_rows<std::int32_t>(
      group + "/sweeps", 1, records,
      [&](const StepRecord& r, std::int32_t* row) { *row = r.object[i].sweeps; });
  if (floor_) append_floor(records, i);
  if (!several()) return;
  for (std::size_t s = 0; s < static_cast<std::size_t>(stylus_count_); ++s) {
    const std::string path = group + stylus_path(s);
    const auto contact = [&](const StepRecord& r) -> const ContactRecord& {
      return r.object[i].contact[s];
    };
    append_contact(records, path, contact);
    append_rows<double>(path + "/proxy", 3, records,
                        [&](const StepRecord& r, double* row) { put(row, contact(r).proxy); });
    append_rows<double>(path + "/force", 3, records,
                        [&](const StepRecord& r, double* row) { put(row, contact(r).force); });
  }
}

// As many rows a step as there are contacts.
void TraceWriter::append_floor(std::span<const StepRecord> records, std::size_t i) {
  const std::string path = floor_path(object_path(i));
  std::vector<std::int32_t> nodes;
  std::vector<float> forces;
  for (const StepRecord& r : records) {
    const ObjectRecord& object = r.object[i];
    for (std::size_t c = 0; c < static_cast<std::size_t>(object.floor_count); ++c) {
      nodes.push_back(object.floor[c].node);
      forces.insert(forces.end(), object.floor[c].force.begin(), object.floor[c].force.end());
    }
  }
  append_rows<std::int32_t>(
      path + "/count", 1, records,
      [&](const StepRecord& r, std::int32_t* row) { *row = r.object[i].floor_count; });
  if (nodes.empty()) return;
  file_.append<std::int32_t>(path + "/node", nodes.size(), nodes.data());
  file_.append<float>(path + "/force", nodes.size(), forces.data());
}

void TraceWriter::append_stylus(std::span<const StepRecord> records, std::size_t s) {
  const std::string path = stylus_path(s);
  const auto vectors = [&](const char* name, const auto& member) {
    append_rows<double>(path + name, 3, records,
                        [&](const StepRecord& r, double* row) { put(row, r.stylus[s].*member); });
  };
  vectors("/tip", &StylusRecord::tip);
  vectors("/proxy", &StylusRecord::proxy);
  vectors("/force", &StylusRecord::force);
  vectors("/applied_force", &StylusRecord::force);
  append_contact(records, path, [s](const StepRecord& r) -> const ContactRecord& {
    static const ContactRecord kNone;
    const int object = r.stylus[s].object;
    return object < 0 ? kNone : r.object[static_cast<std::size_t>(object)].contact[s];
  });
  append_rows<std::uint8_t>(
      path + "/present", 1, records,
      [&](const StepRecord& r, std::uint8_t* row) { *row = r.stylus[s].present ? 1 : 0; });
  append_rows<std::int32_t>(path + "/buttons", 1, records,
                            [&](const StepRecord& r, std::int32_t* row) {
                              *row = static_cast<std::int32_t>(r.stylus[s].buttons);
                            });
  if (!several()) return;
  append_rows<std::int32_t>(
      path + "/object", 1, records,
      [&](const StepRecord& r, std::int32_t* row) { *row = r.stylus[s].object; });
}

void TraceWriter::append_tool(std::span<const StepRecord> records, std::size_t s) {
  const std::string path = stylus_path(s);
  append_rows<double>(path + "/orientation", 4, records, [&](const StepRecord& r, double* row) {
    const Quaternion& q = r.stylus[s].orientation;
    row[0] = q.w();
    Eigen::Map<Vector3>(row + 1, 3) = q.vec();
  });
  append_rows<double>(path + "/torque", 3, records,
                      [&](const StepRecord& r, double* row) { put(row, r.stylus[s].torque); });
}

template <typename Contact>
void TraceWriter::append_contact(std::span<const StepRecord> records, const std::string& group,
                                 const Contact& contact) {
  append_rows<std::uint8_t>(group + "/contact", 1, records,
                            [&](const StepRecord& r, std::uint8_t* row) {
                              *row = static_cast<std::uint8_t>(contact(r).state);
                            });
  append_rows<std::uint8_t>(
      group + "/slipping", 1, records,
      [&](const StepRecord& r, std::uint8_t* row) { *row = contact(r).slipping ? 1 : 0; });
  append_rows<double>(group + "/offset", 3, records,
                      [&](const StepRecord& r, double* row) { put(row, contact(r).offset); });
  append_rows<double>(group + "/arm_shift", 3, records,
                      [&](const StepRecord& r, double* row) { put(row, contact(r).arm_shift); });
  append_rows<double>(group + "/contact_weights", 3, records,
                      [&](const StepRecord& r, double* row) {
                        const bool free = contact(r).state == ContactState::kFree;
                        for (std::size_t i = 0; i < 3; ++i) {
                          row[i] = free ? 0.0 : contact(r).point.weights[i];
                        }
                      });
  append_rows<std::int32_t>(group + "/contact_nodes", 3, records,
                            [&](const StepRecord& r, std::int32_t* row) {
                              const bool free = contact(r).state == ContactState::kFree;
                              for (std::size_t i = 0; i < 3; ++i) {
                                row[i] = free ? -1 : contact(r).point.nodes[i];
                              }
                            });
}

}  // namespace irdm
