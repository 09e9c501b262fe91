// Runs in which objects touch each other and scenery, rerun from their traces.
#include <algorithm>
#include <array>
#include <fstream>
#include <map>
#include <sstream>

#include "common/checksum.hpp"
#include "common/model/model_file.hpp"
#include "replay/reference/fem_reference.hpp"
#include "replay/replay.hpp"
#include "replay/traced_scene.hpp"
#include "simulation/collision/rest_surface.hpp"
#include "tests/replay/rerun_checks.hpp"
#include "tests/server/touching_cubes.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/fem_cube.hpp"
#include "tests/support/slotted_body.hpp"
#include "tests/support/temporary_folder.hpp"
#include "trace/trace_layout.hpp"

using namespace irdm;
using namespace irdm::replay;
using namespace irdm::test;

namespace {

constexpr int kBounceSteps = 120;

std::shared_ptr<const Model> small_cube() {
  return fem_cube({.cells = 2, .poisson_ratio = 0.45});
}

KeptRun bounce(const SimulationConfig& config) {
  KeptRun run(config);
  Simulation simulation(config);
  const auto record = std::make_unique<StepRecord>();
  for (int k = 0; k < kBounceSteps; ++k) {
    step_alone(simulation, *record);
    run.keep(simulation, *record);
  }
  return run;
}

/// Contacts of a run: between its objects, and of them with scenery.
std::pair<int, int> count_contacts(const KeptRun& run) {
  std::pair<int, int> count{0, 0};
  for (const StepRecord& record : run.records) {
    for (const BodyContactRecord& contact : record.body_contacts()) {
      ++(contact.other >= 0 ? count.first : count.second);
    }
  }
  return count;
}

struct Momentum {
  Vector3 linear = Vector3::Zero();
  Vector3 angular = Vector3::Zero();  ///< about the origin
};

// At the end of a step, of all objects.
Momentum momentum(const SimulationConfig& config, const StepRecord& record) {
  Momentum sum;
  for (std::size_t i = 0; i < config.objects.size(); ++i) {
    const BodyProperties& body = config.objects[i].model->body;
    const ObjectRecord& object = record.object[i];
    const Matrix3 Q = object.orientation.toRotationMatrix();
    const Vector3 linear = body.mass * object.velocity;
    sum.linear += linear;
    sum.angular +=
        object.position.cross(linear) + Q * body.inertia * Q.transpose() * object.angular_velocity;
  }
  return sum;
}

void check_momentum_stays(Rerun& made, const KeptRun& run) {
  const Recording recording = run.recording();
  const auto recorded = std::make_unique<StepRecord>();
  const auto again = std::make_unique<StepRecord>();
  const Momentum first = momentum(run.config, run.records[0]);
  for (std::size_t k = 0; k < recording.steps(); ++k) {
    recording.step(k, *recorded);
    made.step(*recorded, *again);
    const Momentum now = momentum(run.config, *again);
    REQUIRE((now.linear - first.linear).norm() < 1e-14);
    REQUIRE((now.angular - first.angular).norm() < 1e-14);
  }
}

TracedScene traced(const KeptRun& run) {
  TracedScene scene;
  scene.config = run.config;
  for (const std::string& name : run.names) scene.objects.push_back({name, "cube.h5", "sum"});
  return scene;
}

}  // namespace

TEST_CASE("a run of objects that touch is rerun, to the bit from its tips") {
  const bool on_plane = GENERATE(false, true);
  const KeptRun run = bounce(touching_cubes(small_cube(), on_plane));
  const auto [between, with_scenery] = count_contacts(run);
  REQUIRE(between > 50);
  REQUIRE((with_scenery > 50) == on_plane);
  check_to_the_bit(run);
  check_from_forces(run);
}

TEST_CASE("a run of objects that fall asleep and wake is rerun, to the bit from its tips",
          "[unsanitized]") {
  SimulationConfig config;
  config.objects.resize(2);
  config.sleep_time = 0.1;
  config.gravity = Vector3(0, -5, 0);
  for (std::size_t i = 0; i < 2; ++i) {
    SimulationObject& object = config.objects[i];
    object.model = fem_cube({.cells = 2, .youngs_modulus = 1e6, .poisson_ratio = 0.45});
    object.position = Vector3(0, 0.06 + 0.12 * static_cast<double>(i), 0);
  }
  config.scenery.resize(1);
  KeptRun run(config);
  Simulation simulation(config);
  const auto record = std::make_unique<StepRecord>();
  int slept = 0;
  int changes = 0;
  bool asleep = false;
  for (int k = 0; k < 800; ++k) {
    StylusCommand command;
    if (k >= 400 && k < 500) command = {true, 0u, Vector3(0, 0.35 - 0.0012 * (k - 400), 0), {}};
    simulation.step({&command, 1}, *record);
    run.keep(simulation, *record);
    slept += record->object[0].asleep ? 1 : 0;
    if (std::exchange(asleep, record->object[1].asleep) != asleep) ++changes;
  }
  REQUIRE(slept > 200);
  REQUIRE(changes >= 2);
  check_to_the_bit(run);
  check_from_forces(run);
}

TEST_CASE("a run on scenery that moves is rerun, to the bit from its tips") {
  SimulationConfig config = touching_cubes(small_cube(), true);
  config.scenery[0].motion.stroke = Vector3(0.01, 0, 0);
  config.scenery[0].motion.velocity = Vector3(0, 0.05, 0);
  config.scenery[0].motion.frequency = 5.0;
  const KeptRun run = bounce(config);
  REQUIRE(count_contacts(run).second > 50);
  check_to_the_bit(run);
  check_from_forces(run);
}

TEST_CASE("a run of an object that touches itself is rerun, to the bit from its tips", "[slow]") {
  const std::shared_ptr<const Model> model = slotted_body({});
  const RestSurface rest(model->mesh);
  SimulationConfig config;
  config.objects.resize(1);
  config.objects[0].model = model;
  config.objects[0].friction = {0.5, 0.5};
  config.objects[0].damping = {20.0, 20.0};
  config.self_contact = true;
  config.styluses = {{0.0, 500.0, 0.0}, {0.0, 500.0, 0.0}};
  std::array<Vector3, 2> outside;
  for (std::size_t s = 0; s < 2; ++s) {
    const double side = s == 0 ? -1.0 : 1.0;
    outside[s] = rest.node(corner_node(*model, kVoxel * Vector3(2.5 * side, 8, 1)));
  }
  KeptRun run(config);
  Simulation simulation(config);
  const auto record = std::make_unique<StepRecord>();
  int closed = 0;
  for (int k = 0; k < 250; ++k) {
    const double in = 0.008 * std::min(1.0, k / 100.0) - 0.001;
    std::array<StylusCommand, 2> commands;
    for (std::size_t s = 0; s < 2; ++s) {
      commands[s] = {true, 0u, outside[s] + Vector3(s == 0 ? in : -in, 0, 0), {}};
    }
    simulation.step(commands, *record);
    run.keep(simulation, *record);
    for (const BodyContactRecord& contact : record->body_contacts()) {
      REQUIRE(contact.other == contact.object);
      ++closed;
    }
  }
  REQUIRE(closed > 50);
  check_to_the_bit(run);
  check_from_forces(run);
}

TEST_CASE("forces of objects on each other add nothing to their momentum when they act again") {
  const KeptRun run = bounce(touching_cubes(small_cube(), false));
  REQUIRE((run.records.back().object[0].velocity - run.records[0].object[0].velocity).norm() > 0.1);
  InputRerun from_inputs(run.config);
  check_momentum_stays(from_inputs, run);
  ForceRerun from_forces(run.config);
  check_momentum_stays(from_forces, run);
}

TEST_CASE("finite elements under the forces of other bodies move as the run did") {
  const KeptRun run = bounce(touching_cubes(small_cube(), GENERATE(false, true)));
  const auto made = fem_reference(traced(run), precompute::Elasticity::kCorotational, 1e-3);
  const Found found = run_again(*made, run);
  double peak = 0.0;
  for (const std::vector<Points>& surfaces : run.displacements) {
    for (const Points& u : surfaces) peak = std::max(peak, u.cwiseAbs().maxCoeff());
  }
  INFO(found.deviation.text() << "displacement " << found.displacement << " m, peak " << peak);
  REQUIRE(peak > 1e-3);
  CHECK(found.deviation.position() < 1e-12);
  CHECK(found.deviation.orientation() < 2e-3);
  CHECK(found.displacement < 0.05 * peak);  // measured: 0.019
}

TEST_CASE("objects of a trace without contacts between bodies go through each other again") {
  SimulationConfig config = touching_cubes(small_cube(), false);
  config.between_objects = false;
  const KeptRun run = bounce(config);
  CHECK(count_contacts(run).first == 0);
  check_to_the_bit(run);
}

namespace {

/// A table: its columns by name, each a word a row.
std::map<std::string, std::vector<std::string>> read_table(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  std::vector<std::string> names;
  const auto words = [](const std::string& text) {
    std::vector<std::string> found;
    std::istringstream stream(text);
    for (std::string word; std::getline(stream, word, ',');) found.push_back(word);
    return found;
  };
  names = words(line);
  std::map<std::string, std::vector<std::string>> table;
  while (std::getline(file, line)) {
    const std::vector<std::string> row = words(line);
    REQUIRE(row.size() == names.size());
    for (std::size_t i = 0; i < row.size(); ++i) table[names[i]].push_back(row[i]);
  }
  return table;
}

/// A trace of two cubes that touch, with its models as files.
struct TracedBounce {
  TracedBounce() {
    const std::filesystem::path model = folder.path() / "cube.h5";
    ModelFileWriter writer(model);
    writer.write_description(*small_cube());
    writer.write_modal(std::get<ModalResponse>(small_cube()->response));
    writer.commit();
    TraceHeader header{{}, "", 0.002, 1, false, true};
    for (const char* name : {"left cube", "right"}) {
      header.objects.push_back({name, "cube.h5", sha256_of_file(model)});
      header.scene += "[[object]]\nname = \"" + std::string(name) + "\"\nmodel = \"cube.h5\"\n";
    }
    header.scene.insert(header.scene.find("[[object]]", 1),
                        "position = [-0.0605, 0, 0]\nvelocity = [0.15, 0, 0]\n");
    header.scene += "position = [0.0605, 0.004, 0.003]\nvelocity = [-0.15, 0, 0.02]\n";
    TraceWriter(trace, header).close();
    config = read_traced_scene(trace, {}, std::nullopt).config;
    std::filesystem::remove(trace);
    Simulation simulation(config);
    records.resize(kBounceSteps);
    for (StepRecord& record : records) step_alone(simulation, record);
    TraceWriter writer_of_steps(trace, header);
    writer_of_steps.append(records);
    writer_of_steps.close();
  }

  TemporaryFolder folder;
  std::filesystem::path trace = folder.path() / "trace.h5";
  SimulationConfig config;
  std::vector<StepRecord> records;
};

Vector3 vector_in(const std::map<std::string, std::vector<std::string>>& table,
                  const std::string& name, const std::string& unit, std::size_t row) {
  Vector3 v;
  for (int axis = 0; axis < 3; ++axis) {
    const std::string column = name + "_" + "xyz"[axis] + unit;
    CAPTURE(column);
    REQUIRE(table.contains(column));
    v[axis] = std::stod(table.at(column)[row]);
  }
  return v;
}

}  // namespace

TEST_CASE("tables have the contacts between bodies: their sums, and each of them") {
  const TracedBounce run;
  ReplayOptions options;
  options.trace = run.trace;
  options.csv = run.folder.path() / "run.csv";
  options.contacts = run.folder.path() / "contacts.csv";
  options.vtk = run.folder.path() / "vtk";
  REQUIRE(replay::replay(options) == 0);
  const auto table = read_table(*options.csv);
  const auto contacts = read_table(*options.contacts);
  REQUIRE(table.at("time_s").size() == kBounceSteps);
  std::size_t row = 0;
  for (std::size_t k = 0; k < kBounceSteps; ++k) {
    Vector3 sum = Vector3::Zero();
    for (const BodyContactRecord& contact : run.records[k].body_contacts()) {
      sum += contact.object == 0 ? contact.force : Vector3(-contact.force);
      REQUIRE(row < contacts.at("time_s").size());
      CHECK(std::stod(contacts.at("time_s")[row]) == run.records[k].time);
      CHECK(contacts.at("object")[row] == (contact.object == 0 ? "left_cube" : "right"));
      CHECK(contacts.at("other")[row] == (contact.other == 0 ? "left_cube" : "right"));
      CHECK(contacts.at("slipping")[row] == (contact.slipping ? "1" : "0"));
      CHECK(vector_in(contacts, "position", "_m", row) == contact.position);
      CHECK(vector_in(contacts, "normal", "", row) == contact.normal);
      CHECK(vector_in(contacts, "force", "_N", row) == contact.force);
      CHECK(vector_in(contacts, "slip", "_m", row) == contact.slip);
      CHECK(std::stod(contacts.at("area_m2")[row]) == contact.area);
      const double pressure = std::stod(contacts.at("pressure_Pa")[row]);
      CHECK(pressure == contact.force.dot(contact.normal) / contact.area);
      CHECK(pressure >= 0.0);
      ++row;
    }
    CHECK(vector_in(table, "left_cube_body_force", "_N", k) == sum);
    CHECK((vector_in(table, "right_body_force", "_N", k) + sum).norm() == 0.0);
    CHECK(std::stoul(table.at("right_body_contacts")[k]) == run.records[k].body_contact.size());
  }
  CHECK(row == contacts.at("time_s").size());
  CHECK(row > 50);
  CHECK(std::filesystem::exists(*options.vtk / "run.pvd"));
}

TEST_CASE("a trace from before objects could touch is rerun as it was") {
  const TracedBounce run;
  CHECK(run.config.between_objects);
  const TraceHeader header = read_trace_header(run.trace);
  CHECK(header.bodies);
  TraceHeader older = header;
  older.objects = {{"left cube", "cube.h5", sha256_of_file(run.folder.path() / "cube.h5")},
                   {"right", "cube.h5", sha256_of_file(run.folder.path() / "cube.h5")}};
  older.bodies = false;
  older.sleep = false;
  const std::filesystem::path path = run.folder.path() / "older.h5";
  TraceWriter(path, older).close();
  CHECK_FALSE(read_traced_scene(path, {}, std::nullopt).config.between_objects);
  CHECK(read_traced_scene(path, {}, std::nullopt).config.sleep_time == 0.0);
}
