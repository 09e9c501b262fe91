#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <limits>
#include <type_traits>

#include "c_interface/caller.hpp"
#include "c_interface/irdm.h"
#include "scene/scene_run.hpp"
#include "simulation/step/step_rows.hpp"

// Rows are handed over as they are: both sides have to have the same layout.
static_assert(sizeof(irdm_stylus) == sizeof(irdm::StylusRow));
static_assert(offsetof(irdm_stylus, torque) == offsetof(irdm::StylusRow, torque));
static_assert(sizeof(irdm_object) == sizeof(irdm::ObjectRow));
static_assert(offsetof(irdm_object, energy) == offsetof(irdm::ObjectRow, energy));
static_assert(sizeof(irdm_contact) == sizeof(irdm::ContactRow));
static_assert(offsetof(irdm_contact, area) == offsetof(irdm::ContactRow, area));
static_assert(IRDM_COUPLING == static_cast<int>(irdm::ContactKind::kCoupling));
static_assert(IRDM_GRAB == irdm::kGrabButton && IRDM_RESET == irdm::kResetButton);

struct irdm_simulation {
  explicit irdm_simulation(const irdm::TomlTable& scene) : run(scene) {}

  irdm::SceneRun run;
  std::array<irdm::StylusCommand, irdm::kMaxStyluses> commands{};
  irdm::Points nodes;  ///< of the last surface
};

namespace {

bool is_object(const irdm_simulation* simulation, std::int32_t object) noexcept {
  return object >= 0 && object < simulation->run.simulation().object_count();
}

irdm::StylusCommand command_of(const irdm_command& command) noexcept {
  irdm::StylusCommand out;
  if (command.present == 0) return out;
  out.present = true;
  out.buttons = command.buttons;
  out.tip = irdm::tip_of(command);
  out.orientation = irdm::orientation_of(command);
  return out;
}

// Copies rows of one layout.
template <typename To, typename From>
void copy_row(const From& from, To& to) noexcept {
  static_assert(sizeof(To) == sizeof(From) && std::is_trivially_copyable_v<From>);
  std::memcpy(&to, &from, sizeof to);
}

}  // namespace

std::int32_t irdm_api_version(void) {
  return IRDM_API_MAJOR * 1000 + IRDM_API_MINOR;
}

const char* irdm_version(void) {
  return IRDM_VERSION;
}

irdm_status irdm_simulation_open(const char* scene_file, irdm_simulation** simulation,
                                 char* message, std::size_t message_size) {
  return irdm::open_handle(scene_file, simulation, message, message_size,
                           [&] { return irdm::TomlTable::parse_file(scene_file); });
}

irdm_status irdm_simulation_parse(const char* scene_text, irdm_simulation** simulation,
                                  char* message, std::size_t message_size) {
  return irdm::open_handle(scene_text, simulation, message, message_size,
                           [&] { return irdm::TomlTable::parse_text(scene_text, "scene"); });
}

void irdm_simulation_close(irdm_simulation* simulation) {
  delete simulation;
}

double irdm_simulation_dt(const irdm_simulation* simulation) {
  return simulation == nullptr ? std::numeric_limits<double>::quiet_NaN()
                               : simulation->run.simulation().dt();
}

std::int32_t irdm_simulation_stylus_count(const irdm_simulation* simulation) {
  return simulation == nullptr ? -1 : simulation->run.stylus_count();
}

std::int32_t irdm_simulation_object_count(const irdm_simulation* simulation) {
  return simulation == nullptr ? -1 : simulation->run.simulation().object_count();
}

std::int32_t irdm_simulation_find_object(const irdm_simulation* simulation, const char* name) {
  if (simulation == nullptr || name == nullptr) return -1;
  const auto& objects = simulation->run.scene().objects;
  const auto found = std::find_if(objects.begin(), objects.end(),
                                  [&](const auto& object) { return object.name == name; });
  return found == objects.end() ? -1 : static_cast<std::int32_t>(found - objects.begin());
}

irdm_status irdm_simulation_step(irdm_simulation* simulation, const irdm_command* commands,
                                 std::size_t command_count, irdm_stylus* styluses) {
  if (simulation == nullptr || commands == nullptr) return IRDM_BAD_ARGUMENT;
  const auto count = static_cast<std::size_t>(simulation->run.stylus_count());
  if (command_count != count) return IRDM_BAD_ARGUMENT;
  for (std::size_t s = 0; s < count; ++s) {
    simulation->commands[s] = command_of(commands[s]);
    if (irdm::fault_of(simulation->commands[s]) != nullptr) return IRDM_BAD_ARGUMENT;
  }
  const irdm::StepRecord& record = simulation->run.step({simulation->commands.data(), count});
  for (std::size_t s = 0; s < count && styluses != nullptr; ++s) {
    copy_row(irdm::row_of(record.stylus[s]), styluses[s]);
  }
  return IRDM_OK;
}

irdm_status irdm_simulation_reset(irdm_simulation* simulation) {
  if (simulation == nullptr) return IRDM_BAD_ARGUMENT;
  simulation->run.reset();
  return IRDM_OK;
}

irdm_status irdm_simulation_save(const irdm_simulation* simulation, void* state,
                                 std::size_t capacity, std::size_t* count) {
  if (simulation == nullptr || count == nullptr) return IRDM_BAD_ARGUMENT;
  if (state == nullptr && capacity > 0) return IRDM_BAD_ARGUMENT;
  try {
    const std::vector<std::byte> saved = simulation->run.save_state();
    *count = saved.size();
    if (capacity < saved.size()) return IRDM_TOO_SMALL;
    std::memcpy(state, saved.data(), saved.size());
    return IRDM_OK;
  } catch (...) {
    return IRDM_FAILED;
  }
}

irdm_status irdm_simulation_load(irdm_simulation* simulation, const void* state, std::size_t size,
                                 char* message, std::size_t message_size) {
  irdm::write_text("", message, message_size);
  if (simulation == nullptr || state == nullptr) return IRDM_BAD_ARGUMENT;
  try {
    simulation->run.load_state({static_cast<const std::byte*>(state), size});
    return IRDM_OK;
  } catch (const std::exception& error) {
    irdm::write_text(error.what(), message, message_size);
  }
  return IRDM_FAILED;
}

irdm_status irdm_simulation_objects(const irdm_simulation* simulation, irdm_object* objects,
                                    std::size_t capacity) {
  if (simulation == nullptr || objects == nullptr) return IRDM_BAD_ARGUMENT;
  const std::span<const irdm::ObjectRow> rows = simulation->run.objects();
  if (capacity < rows.size()) return IRDM_TOO_SMALL;
  if (simulation->run.simulation().next_step() == 0) return IRDM_BAD_ARGUMENT;
  for (std::size_t i = 0; i < rows.size(); ++i) copy_row(rows[i], objects[i]);
  return IRDM_OK;
}

irdm_status irdm_simulation_contacts(const irdm_simulation* simulation, irdm_contact* contacts,
                                     std::size_t capacity, std::size_t* count) {
  if (simulation == nullptr || count == nullptr) return IRDM_BAD_ARGUMENT;
  if (contacts == nullptr && capacity > 0) return IRDM_BAD_ARGUMENT;
  const auto forces = simulation->run.contacts();
  *count = forces.size();
  if (capacity < forces.size()) return IRDM_TOO_SMALL;
  for (std::size_t i = 0; i < forces.size(); ++i) copy_row(forces[i], contacts[i]);
  return IRDM_OK;
}

irdm_status irdm_simulation_surface(irdm_simulation* simulation, std::int32_t object, double* nodes,
                                    std::size_t capacity, std::size_t* count) {
  if (simulation == nullptr || count == nullptr) return IRDM_BAD_ARGUMENT;
  if ((nodes == nullptr && capacity > 0) || !is_object(simulation, object)) {
    return IRDM_BAD_ARGUMENT;
  }
  const irdm::ModelMesh& mesh = simulation->run.model(object)->mesh;
  *count = static_cast<std::size_t>(mesh.surface_node_count());
  if (capacity < *count) return IRDM_TOO_SMALL;
  try {
    simulation->run.surface(object, simulation->nodes);
  } catch (...) {
    return IRDM_FAILED;
  }
  std::copy_n(simulation->nodes.data(), simulation->nodes.size(), nodes);
  return IRDM_OK;
}

irdm_status irdm_simulation_triangles(const irdm_simulation* simulation, std::int32_t object,
                                      std::int32_t* triangles, std::size_t capacity,
                                      std::size_t* count) {
  if (simulation == nullptr || count == nullptr) return IRDM_BAD_ARGUMENT;
  if ((triangles == nullptr && capacity > 0) || !is_object(simulation, object)) {
    return IRDM_BAD_ARGUMENT;
  }
  const irdm::Triangles& of = simulation->run.model(object)->mesh.triangles;
  *count = static_cast<std::size_t>(of.rows());
  if (capacity < *count) return IRDM_TOO_SMALL;
  std::copy_n(of.data(), of.size(), triangles);
  return IRDM_OK;
}
