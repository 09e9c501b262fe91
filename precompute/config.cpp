#include "precompute/config.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "common/config/range.hpp"
#include "common/error.hpp"
#include "precompute/mesh/mesh_file.hpp"

namespace irdm::precompute {
namespace {

constexpr double kDefaultFirstStep = 1e-4;
constexpr double kTargetStrain = 1e-4;
constexpr int kMaxStepsPerInterval = 100'000;
constexpr int kMaxHold = 1'000'000;
// What decimal numbers in a file may miss of dividing dt.
constexpr double kDivides = 1e-6;

double read_step(TomlTable& table, const std::string& key, double dt) {
  const double step = table.number(key, above(0));
  const double count = dt / step;
  if (step > dt * (1.0 + kDivides)) {
    table.fail(key, "is longer than response.dt", "make it dt over a whole number");
  }
  if (count > kMaxStepsPerInterval) {
    table.fail(key, "is too short: more than 100 000 steps in response.dt", "make it longer");
  }
  if (std::abs(count - std::round(count)) > kDivides * count) {
    table.fail(key, "does not divide response.dt", "make it dt over a whole number");
  }
  return dt / std::round(count);
}

}  // namespace

TimeSteppingConfig read_time_stepping(TomlTable table, double dt) {
  TimeSteppingConfig config;
  config.model = table.choice("model", {"corotational", "linear"}, "corotational") == "linear"
                     ? Elasticity::kLinear
                     : Elasticity::kCorotational;
  const double default_first = dt / std::ceil(dt / kDefaultFirstStep * (1.0 - kDivides));
  config.first_step = table.has("first_step") ? read_step(table, "first_step", dt) : default_first;
  config.last_step = table.has("last_step") ? read_step(table, "last_step", dt) : dt;
  if (config.last_step < config.first_step) {
    table.fail("last_step", "is shorter than first_step", "make it first_step or longer");
  }
  config.hold = table.integer("hold", 1, kMaxHold, config.hold);
  if (table.has("force")) config.force = table.number("force", lab::kProbeForce);
  config.rotation_weights = table.choice("rotation_weights", {"mass", "none"}, "mass") == "mass"
                                ? RotationWeights::kMass
                                : RotationWeights::kNone;
  table.finish();
  return config;
}

std::vector<int> step_schedule(const TimeSteppingConfig& config, double dt, int intervals) {
  const int fewest = static_cast<int>(std::lround(dt / config.last_step));
  int count = static_cast<int>(std::lround(dt / config.first_step));
  std::vector<int> schedule;
  for (int k = 0; k < intervals; ++k) {
    if (k > 0 && k % config.hold == 0) count = std::max(fewest, (count + 1) / 2);
    schedule.push_back(count);
  }
  return schedule;
}

double default_force(const SoftBody& body, double youngs_modulus) {
  return kTargetStrain * youngs_modulus * std::pow(body.volume() / body.node_count(), 2.0 / 3.0);
}

namespace {

constexpr int kMostModes = 20'000;

ModeSolver solver_from_word(const std::string& word) {
  static const std::map<std::string, ModeSolver> words{
      {"spectra", ModeSolver::kSpectra},
      {"slepc", ModeSolver::kSlepc},
      {"slepc-multigrid", ModeSolver::kSlepcMultigrid}};
  return words.at(word);
}

}  // namespace

ModesConfig read_modes(TomlTable table) {
  ModesConfig modes;
  if (table.has("count") + table.has("highest_frequency") + table.has("error") > 1) {
    table.fail("", "has more than one of count, highest_frequency and error",
               "choose one, or none for all modes");
  }
  if (table.has("count")) modes.count = table.integer("count", 1, kMostModes, 1);
  if (table.has("highest_frequency")) {
    modes.highest_frequency = table.number("highest_frequency", lab::kFrequency);
  }
  if (table.has("error")) modes.error = table.number("error", between(1e-4, 0.5));
  for (const char* key : {"contact_radius", "solver"}) {
    if (table.has(key) && modes.all()) {
      table.fail(key, "is there but all modes are asked for",
                 "give one of count, highest_frequency and error, or leave it out");
    }
  }
  modes.contact_radius = table.number("contact_radius", lab::kLength, modes.contact_radius);
  modes.solver =
      solver_from_word(table.choice("solver", {"spectra", "slepc", "slepc-multigrid"}, "spectra"));
  table.finish();
  return modes;
}

namespace {

constexpr int kMaxCells = 100;

BoxConfig read_box(TomlTable table) {
  BoxConfig box;
  const std::vector<double> size = table.numbers("size", 3, lab::kLength);
  const std::vector<double> cells = table.numbers("cells", 3, between(1, kMaxCells));
  for (std::size_t k = 0; k < 3; ++k) {
    box.size(static_cast<Eigen::Index>(k)) = size[k];
    if (cells[k] != std::floor(cells[k])) {
      table.fail("cells", "has a number that is not whole", "give three whole numbers");
    }
    box.cells[k] = static_cast<int>(cells[k]);
  }
  table.finish();
  return box;
}

double unit_from_word(const std::string& word) {
  static const std::map<std::string, double> words{{"m", 1.0}, {"cm", 1e-2}, {"mm", 1e-3}};
  return words.at(word);
}

MeshConfig read_mesh(TomlTable table) {
  MeshConfig mesh;
  if (table.has("box") == table.has("file")) {
    table.fail("", table.has("box") ? "has both box and file" : "has neither box nor file",
               "give one of box = { size = [..], cells = [..] } and file = \"name\"");
  }
  const bool surface = table.has("file") && is_surface_file(table.path("file"));
  if (table.has("edge_length") && !surface) {
    table.fail("edge_length", "belongs to a surface (.stl, .obj, .ply)",
               table.has("box") ? "leave it out: cells says how fine a box is"
                                : "leave it out: this file says its own sizes");
  }
  if (table.has("box")) {
    if (table.has("unit")) {
      table.fail("unit", "belongs to a mesh file", "leave it out: a box is given in metres");
    }
    mesh.source = read_box(table.table("box"));
  } else {
    mesh.source = table.path("file");
    mesh.unit = unit_from_word(table.choice("unit", {"m", "cm", "mm"}, "m"));
    if (table.has("edge_length")) mesh.edge_length = table.number("edge_length", lab::kLength);
  }
  mesh.order = table.integer("order", 1, 2, mesh.order);
  table.finish();
  return mesh;
}

Material read_material(TomlTable table) {
  Material material;
  material.youngs_modulus = table.number("youngs_modulus", lab::kYoungsModulus);
  material.poisson_ratio = table.number("poisson_ratio", lab::kPoissonRatio);
  material.density = table.number("density", lab::kDensity);
  material.rayleigh_alpha = table.number("rayleigh_alpha", lab::kRayleighAlpha, 8.0);
  material.rayleigh_beta = table.number("rayleigh_beta", lab::kRayleighBeta, 2e-4);
  table.finish();
  return material;
}

// The place of half precision and zfp is taken by the compressed form.
void refuse_removed_forms(TomlTable& table) {
  const std::string remedy = "irdm-precompute compress makes dense R small";
  for (const char* key : {"compression", "compression_error"}) {
    if (table.has(key)) table.fail(key, "is not a key any more", "leave it out; " + remedy);
  }
  if (table.text("precision", "single") == "half") {
    table.fail("precision", "is 'half', which there is not any more", "use \"single\"; " + remedy);
  }
}

ResponseConfig read_response(TomlTable table) {
  ResponseConfig response;
  response.dt = table.number("dt", lab::kStepTime, response.dt);
  response.steps = table.integer("steps", 1, lab::kMostSteps, response.steps);
  response.method = method_from_word(table.choice("method", {"modal", "time-stepping"}, "modal"));
  response.storage =
      storage_from_word(table.choice("storage", {"modal", "dense", "both"}, "modal"));
  refuse_removed_forms(table);
  const std::string precision = table.choice("precision", {"single", "double"}, "single");
  response.precision = precision == "double" ? Precision::kDouble : Precision::kSingle;
  table.choice("support", {"floating", "fixed"}, "floating");  // see read_support
  table.finish();
  return response;
}

Vector3 vector(TomlTable& table, const std::string& key, const Range& range) {
  return Eigen::Map<const Vector3>(table.numbers(key, 3, range).data());
}

HalfSpace read_half_space(TomlTable table) {
  HalfSpace half{vector(table, "point", lab::kMeshPlace), vector(table, "normal", lab::kComponent)};
  if (half.normal.norm() < 1e-6) table.fail("normal", "is zero", "give it a direction");
  table.finish();
  return half;
}

BoxRegion read_box_region(TomlTable table) {
  BoxRegion box{vector(table, "min", lab::kMeshPlace), vector(table, "max", lab::kMeshPlace)};
  if ((box.lowest.array() > box.highest.array()).any()) {
    table.fail("min", "is above max", "exchange them");
  }
  table.finish();
  return box;
}

Region read_region(TomlTable table) {
  if (table.has("half_space") + table.has("box") + table.has("group") != 1) {
    table.fail("", "has not exactly one of half_space, box and group",
               "give half_space = { point = [..], normal = [..] }, "
               "box = { min = [..], max = [..] } or group = \"name\"");
  }
  Region region;
  if (table.has("half_space")) region = read_half_space(table.table("half_space"));
  if (table.has("box")) region = read_box_region(table.table("box"));
  if (table.has("group")) region = GroupRegion{table.text("group")};
  table.finish();
  return region;
}

std::optional<Region> read_support(TomlTable& root) {
  const std::string word =
      root.table("response").choice("support", {"floating", "fixed"}, "floating");
  if (word == "fixed") return read_region(root.table("support", true));
  if (root.has("support")) {
    root.fail("support", "is there but the body is floating",
              "set response.support = \"fixed\" or leave the table out");
  }
  return std::nullopt;
}

}  // namespace

Storage storage_from_word(const std::string& word) {
  static const std::map<std::string, Storage> words{
      {"modal", Storage::kModal}, {"dense", Storage::kDense}, {"both", Storage::kBoth}};
  return words.at(word);
}

Method method_from_word(const std::string& word) {
  static const std::map<std::string, Method> words{{"modal", Method::kModal},
                                                   {"time-stepping", Method::kTimeStepping}};
  return words.at(word);
}

PrecomputeConfig read_config(TomlTable root, const std::string& name) {
  PrecomputeConfig config;
  config.name = name;
  config.mesh = read_mesh(root.table("mesh", true));
  config.material = read_material(root.table("material", true));
  config.response = read_response(root.table("response"));
  config.modes = read_modes(root.table("modes"));
  config.support = read_support(root);
  config.time_stepping = read_time_stepping(root.table("time_stepping"), config.response.dt);
  root.finish();
  return config;
}

PrecomputeConfig load_config(const std::filesystem::path& path) {
  return read_config(TomlTable::parse_file(path), path.string());
}

}  // namespace irdm::precompute
