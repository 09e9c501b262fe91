// Scenes for other engines, and the same by irdm: two soft cubes that uniform body forces press
// together, face on face, beside finite elements; and the gallery's peg, led at a constant speed.
//   bench_engines --scenes FILE.json     writes meshes, loads and what finite elements say
//   bench_engines                        prints a row of each table (bench/engines/run.sh)
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "bench/statistics.hpp"
#include "simulation/step/simulation.hpp"
#include "tests/simulation/touching_cubes.hpp"
#include "tests/support/fem_contact.hpp"

using namespace irdm;
using nlohmann::json;

namespace {

constexpr double kDt = 0.001;       // [s]
constexpr double kDamping = 20.0;   // of all motion [1/s]
constexpr double kReach = 0.012;    // of contacts of the reference [m]
constexpr double kPressRamp = 0.7;  // [s]
constexpr double kPressTime = 1.4;  // [s]
constexpr double kPressFriction = 0.0;

const test::FemCube kPressed{.cells = 6, .youngs_modulus = 5000.0, .dt = kDt, .poisson_ratio = 0.3};

// As configs/models/soft-cube.toml and configs/scenes/peg.toml.
const test::FemCube kPegCube{.cells = 4, .dt = kDt, .poisson_ratio = 0.45};
constexpr double kRadius = 0.02;      // of the pusher [m]
constexpr double kCoupling = 2000.0;  // [N/m]
constexpr double kSpeed = 0.05;       // [m/s]
constexpr double kFrom = 0.2;         // x of the pusher's foremost point [m]
constexpr double kTo = 0.05;
constexpr double kPegTime = 4.0;  // [s]
constexpr double kPostRadius = 0.03;
constexpr double kPostAside = 0.085;
constexpr double kTable = 0.2;  // friction; kinetic: 0.15
constexpr double kPost = 0.1;
const Vector3 kPegStart(0.1, test::kHalfEdge, 0);

/// From the middle of the box to the centre of mass [m].
Vector3 middle_to_centre(const Model& model) {
  return model.mesh.com_offset - Vector3::Constant(test::kHalfEdge);
}

json vector(const Vector3& x) {
  return {x.x(), x.y(), x.z()};
}

// Nodes are from the middle of the box.
json body_of(const Model& model) {
  const ModelMesh& mesh = model.mesh;
  json body;
  for (Eigen::Index i = 0; i < mesh.nodes.rows(); ++i) {
    body["nodes"].push_back(vector(mesh.nodes.row(i).transpose() + middle_to_centre(model)));
    body["mass"].push_back(mesh.node_mass(i));
  }
  for (Eigen::Index e = 0; e < mesh.tets.rows(); ++e) {
    const auto tet = mesh.tets.row(e);
    body["tets"].push_back({tet(0), tet(1), tet(2), tet(3)});
  }
  body["surface"] = mesh.surface_nodes;
  for (Eigen::Index t = 0; t < mesh.triangles.rows(); ++t) {
    json corners;
    for (int i = 0; i < 3; ++i) {
      corners.push_back(mesh.surface_nodes[static_cast<std::size_t>(mesh.triangles(t, i))]);
    }
    body["triangles"].push_back(corners);
  }
  body["young"] = model.material.youngs_modulus;
  body["poisson"] = model.material.poisson_ratio;
  body["alpha"] = model.material.rayleigh_alpha;
  body["beta"] = model.material.rayleigh_beta;
  return body;
}

// One stands on the other; as they are at rest, the centre of mass of each.
SimulationConfig pressed_cubes() {
  SimulationConfig config;
  config.objects.resize(2);
  double side = -1.0;
  for (SimulationObject& object : config.objects) {
    object.model = test::fem_cube(kPressed);
    object.friction = {kPressFriction, kPressFriction};
    object.damping = {kDamping, kDamping};
    object.tether.angular_stiffness = 50.0;
    object.position = Vector3(0, side * test::kHalfEdge, 0) + middle_to_centre(*object.model);
    side = 1.0;
  }
  config.objects[0].tether.stiffness = 5000.0;  // bears what the other weighs
  return config;
}

/// Approach of the centres of mass by finite elements of the same mesh, and of one with cells half
/// the size [m].
std::pair<double, double> reference() {
  const SimulationConfig config = pressed_cubes();
  const Model& model = *config.objects[0].model;
  const auto approach = [&](const test::FemContactBody& body) {
    test::FemContactBody lower = body;
    test::FemContactBody upper = body;
    const Vector3 shift = model.mesh.com_offset - body.mesh.com_offset;
    lower.position = config.objects[0].position - shift;
    upper.position = config.objects[1].position - shift;
    return test::fem_contact(lower, upper, {model.body.mass * test::kGravity, false}, kReach)
        .approach;
  };
  return {approach({model.mesh, model.material, {}, {}}),
          approach(test::fine_cube(2 * kPressed.cells, 1, model.material))};
}

void write_scenes(const std::string& file) {
  const auto [same, fine] = reference();
  json scenes;
  scenes["press"] = {{"dt", kDt},
                     {"seconds", kPressTime},
                     {"ramp", kPressRamp},
                     {"gravity", test::kGravity},
                     {"friction", kPressFriction},
                     {"damping", kDamping},
                     {"fem", {{"approach", same}, {"fine", fine}}},
                     {"body", body_of(*test::fem_cube(kPressed))}};
  json posts;
  for (const double z : {kPostAside, -kPostAside}) {
    posts.push_back(
        {{"position", vector({0, test::kHalfEdge, z})}, {"radius", kPostRadius}, {"length", 0.2}});
  }
  scenes["peg"] = {{"dt", kDt},
                   {"seconds", kPegTime},
                   {"gravity", test::kGravity},
                   {"damping", 0.5},
                   {"friction", {{"table", kTable}, {"posts", kPost}, {"pusher", 0.5}}},
                   {"speed", kSpeed},
                   {"from", kFrom + kRadius},
                   {"to", kTo + kRadius},
                   {"radius", kRadius},
                   {"position", vector(kPegStart)},
                   {"posts", posts},
                   {"body", body_of(*test::fem_cube(kPegCube))}};
  std::ofstream(file) << scenes;
}

/// Of all surface nodes after a step, W.
std::vector<Vector3> surface(const SoftObject& object) {
  Points u;
  object.engine().displacement(u);
  std::vector<Vector3> nodes;
  for (int i = 0; i < object.model().mesh.surface_node_count(); ++i) {
    nodes.push_back(object.state().position +
                    object.state().orientation *
                        (object.model().mesh.rest_position(i) + Vector3(u.row(i).transpose())));
  }
  return nodes;
}

void print_times(const char* scene, const char* engine, const std::vector<double>& times) {
  std::printf("%s | irdm%s | %.0f | %.0f, %.0f | ", scene, engine, 1e3 * kDt,
              bench::percentile(times, 0.5), bench::percentile(times, 0.99));
}

/// Processor time [us].
double step_time(Simulation& simulation, const StylusCommand& command, StepRecord& record) {
  return 1e6 * bench::elapsed([&] { simulation.step({&command, 1}, record); }).cpu;
}

void press() {
  const SimulationConfig config = pressed_cubes();
  Simulation simulation(config);
  const auto record = std::make_unique<StepRecord>();
  const StylusCommand nobody;
  Settings settings = simulation.settings();
  std::vector<double> times;
  const int steps = static_cast<int>(std::lround(kPressTime / kDt));
  for (int k = 0; k < steps; ++k) {
    const double load = std::min(1.0, k * kDt / kPressRamp);
    settings.gravity = Vector3(0, -test::kGravity * load, 0);
    simulation.set(settings);
    const double time = step_time(simulation, nobody, *record);
    if (2 * k > steps) times.push_back(time);
  }
  // Nodes that lie on each other.
  const std::vector<Vector3> lower = surface(simulation.object(0));
  const std::vector<Vector3> upper = surface(simulation.object(1));
  const ModelMesh& mesh = simulation.object(0).model().mesh;
  const Vector3 shift = middle_to_centre(simulation.object(0).model());
  double depth = 0.0;
  for (int i = 0; i < mesh.surface_node_count(); ++i) {
    const Vector3 top = mesh.rest_position(i) + shift;
    if (std::abs(top.y() - test::kHalfEdge) > 1e-6) continue;
    for (int j = 0; j < mesh.surface_node_count(); ++j) {
      const Vector3 off = mesh.rest_position(j) + shift - top;
      if ((off + Vector3(0, 2.0 * test::kHalfEdge, 0)).norm() > 1e-6) continue;
      depth = std::max(
          depth, lower[static_cast<std::size_t>(i)].y() - upper[static_cast<std::size_t>(j)].y());
    }
  }
  const auto apart = [](const auto& objects) {
    return objects[1].position.y() - objects[0].position.y();
  };
  const double approach = apart(config.objects) - apart(record->object);
  const auto [same, fine] = reference();
  print_times("press", "", times);
  std::printf("%.2f mm | %.1f %% | %.3f |\n", 1e3 * approach, 100 * (same / approach - 1.0),
              1e3 * depth);
  std::printf("press | finite elements, half the cells' size | | | %.2f mm | %.1f %% | |\n",
              1e3 * fine, 100 * (same / fine - 1.0));
}

SimulationConfig peg_scene(const test::FemCube& cube) {
  SimulationConfig config;
  config.gravity = Vector3(0, -test::kGravity, 0);
  config.objects.resize(1);
  config.objects[0].model = test::fem_cube(cube);
  config.objects[0].position = kPegStart + middle_to_centre(*config.objects[0].model);
  config.objects[0].damping = {0.5, 1.0};
  config.styluses = {{kRadius, kCoupling, 0.0}};
  config.scenery.resize(3);
  config.scenery[0].friction = {kTable, 0.15};
  for (std::size_t i : {1, 2}) {
    config.scenery[i].shape = CapsuleShape{kPostRadius, 0.2};
    config.scenery[i].position = Vector3(0, test::kHalfEdge, i == 1 ? kPostAside : -kPostAside);
    config.scenery[i].friction = {kPost, kPost};
  }
  return config;
}

void peg(const char* name, const test::FemCube& cube) {
  Simulation simulation(peg_scene(cube));
  const auto record = std::make_unique<StepRecord>();
  std::vector<double> times;
  double peak = 0.0;
  double depth = 0.0;
  const int steps = static_cast<int>(std::lround(kPegTime / kDt));
  for (int k = 0; k < steps; ++k) {
    const double x = std::max(kTo, kFrom - kSpeed * (k + 1) * kDt);
    const StylusCommand command = test::at_tip({x, test::kHalfEdge, 0});
    times.push_back(step_time(simulation, command, *record));
    peak = std::max(peak, record->stylus[0].force.x());
    for (const Vector3& node : surface(simulation.object())) {
      const auto post = [&](double z) { return kPostRadius - std::hypot(node.x(), node.z() - z); };
      depth = std::max({depth, -node.y(), post(kPostAside), post(-kPostAside)});
    }
  }
  print_times("peg", name, times);
  std::printf("%.2f N | %.2f N | %.3f |\n", peak, record->stylus[0].force.x(), 1e3 * depth);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 3 && std::string(argv[1]) == "--scenes") {
    write_scenes(argv[2]);
    return 0;
  }
  press();
  peg("", kPegCube);
  test::FemCube fine = kPegCube;
  fine.cells = 8;
  peg(", half the cells' size", fine);
}
