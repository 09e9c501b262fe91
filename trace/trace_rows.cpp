#include "trace/trace_rows.hpp"

#include <algorithm>
#include <limits>
#include <string_view>

#include "common/error.hpp"
#include "simulation/step/settings.hpp"

namespace irdm::trace {
namespace {

constexpr std::string_view kSettings = "/settings";
constexpr std::uint8_t kLastContactState = 2;

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

// Static and kinetic; infinite: it never slips, which no scene says but a program may.
void check_friction(const std::string& set, const std::vector<double>& friction,
                    const TraceCheck& check) {
  for (std::size_t i = 0; i < friction.size(); ++i) {
    if (friction[i] != std::numeric_limits<double>::infinity()) {
      check.number(set, i / 2, friction[i], lab::kFriction);
    }
    if (i % 2 == 1 && friction[i] > friction[i - 1]) {
      check.refuse(set, i / 2, "is more while it slides than while it sticks");
    }
  }
}

// What the step bears depends on the model: that of the recording bore it.
void check_restraints(const SettingsRows& rows, const TraceCheck& check,
                      const SimulationConfig& config) {
  for (std::size_t e = 0; e < rows.settings.size(); ++e) {
    try {
      irdm::check_restraints(config, rows.settings[e]);
    } catch (const Error& error) {
      check.refuse("/settings", e, std::string("cannot be: ") + error.what());
    }
  }
}

}  // namespace

ContactRows::ContactRows(const hdf5::File& file, const RowReader& reader, const TraceCheck& check,
                         const std::string& path, int node_count)
    : state(reader.read<std::uint8_t>(path + "/contact")),
      slipping(reader.read<std::uint8_t>(path + "/slipping")),
      nodes(reader.read<std::int32_t>(path + "/contact_nodes", 3)),
      weights(reader.read<double>(path + "/contact_weights", 3)),
      force(reader.read<double>(path + "/force", 3)),
      proxy(reader.read<double>(path + "/proxy", 3)),
      offset(reader.read<double>(path + "/offset", 3)),
      arm_shift(reader.read<double>(path + "/arm_shift", 3)) {
  check.flags(path + "/contact", state, 1, kLastContactState);
  check.flags(path + "/slipping", slipping);
  check.numbers(path + "/force", force, 3);
  check.numbers(path + "/proxy", proxy, 3);
  check.numbers(path + "/offset", offset, 3);
  check.numbers(path + "/arm_shift", arm_shift, 3);
  leave_out_implausible();
  for (std::size_t k = 0; k < state.size(); ++k) {
    if (state[k] == 0) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      if (nodes[3 * k + i] >= 0 && nodes[3 * k + i] < node_count) continue;
      throw Error(file.name(), path + " touches a node that the model does not have",
                  "use the model that it was recorded with");
    }
    check.weights(path + "/contact_weights", weights, k);
  }
}

// A stylus that was where no hand is drew its contact just as far; there is none in such a step.
void ContactRows::leave_out_implausible() {
  for (std::size_t i = 0; i < offset.size(); ++i) {
    if (lab::kPlace.contains(offset[i]) && lab::kPlace.contains(arm_shift[i])) continue;
    state[i / 3] = 0;
    offset[i] = arm_shift[i] = 0.0;
  }
}

FloorRows read_floor(const hdf5::File& file, const RowReader& reader, const TraceCheck& check,
                     const std::string& path, int node_count) {
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
    for (std::size_t r = rows.first.back(); r < next; ++r) {
      for (std::size_t i = 3 * r; i < 3 * r + 3; ++i) {
        check.number(path + "/force", rows.first.size() - 1, static_cast<double>(rows.force[i]));
      }
    }
    rows.first.push_back(next);
  }
  for (std::size_t r = 0; r < rows.first.back(); ++r) {
    if (rows.node[r] >= 0 && rows.node[r] < node_count) continue;
    throw Error(file.name(), path + " touches a node that the model does not have",
                "use the model that it was recorded with");
  }
  return rows;
}

SettingsRows read_settings(const hdf5::File& file, const SimulationConfig& config,
                           std::uint64_t last_step) {
  SettingsRows rows;
  const EventReader reader(file, std::string(kSettings), {"/force_step", "/gravity"}, last_step);
  rows.force_step = reader.force_step();
  const hsize_t count = reader.rows();
  if (count == 0) throw Error(file.name(), "/settings has no row", "record it again");
  rows.settings.resize(count);
  const TraceCheck check(file.name(), rows.force_step);
  const auto gravity = reader.read<double>("/gravity", 3);
  check.numbers("/settings/gravity", gravity, 3, lab::kGravity);
  for (std::size_t e = 0; e < count; ++e) rows.settings[e].gravity = vector_of(gravity, e);
  for (std::size_t i = 0; i < config.objects.size(); ++i) {
    const std::string group = settings_path(i);
    const std::string object = group.substr(kSettings.size());
    const auto friction = reader.read<double>(object + "/friction", 2);
    const auto damping = reader.read<double>(object + "/damping", 2);
    const auto tether = reader.read<double>(object + "/tether", 2);
    const auto material = reader.read<double>(object + "/material_damping");
    const auto loading = reader.read<std::uint8_t>(object + "/inertial_loading");
    check_friction(group + "/friction", friction, check);
    check.numbers(group + "/damping", damping, 2, lab::kStiffness);  // restraints say more
    check.numbers(group + "/tether", tether, 2, lab::kStiffness);
    check.numbers(group + "/material_damping", material, 1, lab::kMaterialDamping);
    check.flags(group + "/inertial_loading", loading);
    for (std::size_t e = 0; e < count; ++e) {
      rows.settings[e].object[i] = {{friction[2 * e], friction[2 * e + 1]},
                                    {damping[2 * e], damping[2 * e + 1]},
                                    {tether[2 * e], tether[2 * e + 1]},
                                    material[e],
                                    loading[e] != 0};
    }
  }
  check_restraints(rows, check, config);
  return rows;
}

LateRows read_late(const hdf5::File& file, const SimulationConfig& config,
                   std::uint64_t last_step) {
  LateRows rows;
  const EventReader reader(
      file, "/late",
      {"/force_step", "/age", "/object", "/stylus", "/contact_nodes", "/contact_weights", "/force",
       "/arm", "/body_position", "/body_orientation", "/body_velocity", "/body_angular_momentum"},
      last_step);
  rows.force_step = reader.force_step();
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
  const TraceCheck check(file.name(), rows.force_step);
  check.numbers("/late/force", force, 3);
  check.numbers("/late/arm", arm, 3, lab::kPlace);
  check.numbers("/late/body_position", rows.position, 3);
  check.orientations("/late/body_orientation", rows.orientation);
  check.numbers("/late/body_velocity", rows.velocity, 3);
  check.numbers("/late/body_angular_momentum", rows.angular_momentum, 3);
  for (std::size_t e = 0; e < count; ++e) {
    LateForce late{object[e], stylus[e], age[e], {}, vector_of(force, e), vector_of(arm, e)};
    for (std::size_t i = 0; i < 3; ++i) {
      late.point.nodes[i] = nodes[3 * e + i];
      late.point.weights[i] = weights[3 * e + i];
    }
    check_late(late, config, file.name());
    check.weights("/late/contact_weights", weights, e);
    rows.late.push_back(late);
  }
  return rows;
}

BridgedRows read_bridged(const hdf5::File& file, const SimulationConfig& config,
                         std::uint64_t last_step) {
  BridgedRows rows;
  const EventReader reader(file, "/bridged",
                           {"/force_step", "/stylus", "/object", "/force", "/arm"}, last_step);
  rows.force_step = reader.force_step();
  const hsize_t count = reader.rows();
  rows.stylus = reader.read<std::int32_t>("/stylus");
  const auto object = reader.read<std::int32_t>("/object");
  const auto force = reader.read<double>("/force", 3);
  const auto arm = reader.read<double>("/arm", 3);
  const TraceCheck check(file.name(), rows.force_step);
  check.numbers("/bridged/force", force, 3);
  check.numbers("/bridged/arm", arm, 3, lab::kPlace);
  std::vector<double> share;  // older traces have none
  if (file.exists("/bridged/share")) share = reader.read<double>("/share");
  check.numbers("/bridged/share", share, 1, between(0.0, 1.0));
  for (std::size_t e = 0; e < count; ++e) {
    const std::int32_t stylus = rows.stylus[e];
    if (stylus < 0 || stylus >= static_cast<std::int32_t>(config.styluses.size()) ||
        object[e] < -1 || object[e] >= static_cast<std::int32_t>(config.objects.size())) {
      throw Error(file.name(), "/bridged speaks of a stylus or an object that the scene lacks",
                  "use the scene that it was recorded with");
    }
    rows.bridged.push_back({vector_of(force, e), vector_of(arm, e), object[e], {}});
    if (!share.empty()) rows.bridged.back().share = share[e];
  }
  return rows;
}

}  // namespace irdm::trace
