#include "precompute/config.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "common/config/range.hpp"
#include "common/error.hpp"
#include "precompute/fem/material.hpp"

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
constexpr double kSmallestModesError = 1e-4;
constexpr double kLargestModesError = 0.5;

ModeSolver solver_from_word(const std::string& word) {
  static const std::map<std::string, ModeSolver> words{
      {"spectra", ModeSolver::kSpectra},
      {"slepc", ModeSolver::kSlepc},
      {"slepc-multigrid", ModeSolver::kSlepcMultigrid}};
  return words.at(word);
}

double read_error(TomlTable& table) {
  const double error = table.number("error", between(0.0, kLargestModesError));
  if (error > 0.0 && error < kSmallestModesError) {
    table.fail("error", "is below 1e-4", "make it 1e-4 or more, or 0 for all modes");
  }
  return error;
}

}  // namespace

ModesConfig read_modes(TomlTable table) {
  ModesConfig modes;
  if (table.has("count") + table.has("highest_frequency") + table.has("error") > 1) {
    table.fail("", "has more than one of count, highest_frequency and error", "choose one");
  }
  if (table.has("count")) modes.count = table.integer("count", 1, kMostModes, 1);
  if (table.has("highest_frequency")) {
    modes.highest_frequency = table.number("highest_frequency", lab::kFrequency);
  }
  if (table.has("error")) modes.error = read_error(table);
  for (const char* key : {"contact_radius", "solver"}) {
    if (table.has(key) && modes.all()) {
      table.fail(key, "is there but all modes are asked for",
                 "give one of count, highest_frequency and an error above 0, or leave it out");
    }
  }
  modes.contact_radius = table.number("contact_radius", lab::kLength, modes.contact_radius);
  modes.solver =
      solver_from_word(table.choice("solver", {"spectra", "slepc", "slepc-multigrid"}, "spectra"));
  table.finish();
  return modes;
}

namespace {

Material read_material(TomlTable table) {
  Material material;
  table.boolean("rigid", false);  // see read_config
  material.youngs_modulus = table.number("youngs_modulus", lab::kYoungsModulus);
  material.poisson_ratio = table.number("poisson_ratio", kPoissonRatio);
  material.density = table.number("density", lab::kDensity);
  material.rayleigh_alpha = table.number("rayleigh_alpha", lab::kRayleighAlpha, 8.0);
  material.rayleigh_beta = table.number("rayleigh_beta", lab::kRayleighBeta, 2e-4);
  table.finish();
  return material;
}

Support read_support(TomlTable& response) {
  return response.choice("support", {"floating", "fixed"}, "floating") == "fixed"
             ? Support::kFixed
             : Support::kFloating;
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
  response.support = read_support(table);
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

BallRegion read_ball_region(TomlTable table) {
  BallRegion ball{vector(table, "centre", lab::kMeshPlace), table.number("radius", lab::kLength)};
  table.finish();
  return ball;
}

constexpr const char* kShapes =
    "half_space = { point = [..], normal = [..] }, box = { min = [..], max = [..] }, "
    "ball = { centre = [..], radius = .. } or group = \"name\"";

int count_shapes(const TomlTable& table) {
  return table.has("half_space") + table.has("box") + table.has("ball") + table.has("group");
}

// One of them is there.
Region read_shape(TomlTable& table) {
  if (table.has("half_space")) return read_half_space(table.table("half_space"));
  if (table.has("box")) return read_box_region(table.table("box"));
  if (table.has("ball")) return read_ball_region(table.table("ball"));
  return GroupRegion{table.text("group")};
}

Region read_region(TomlTable table) {
  if (count_shapes(table) != 1) {
    table.fail("", "has not exactly one of half_space, box, ball and group",
               std::string("give ") + kShapes);
  }
  const Region region = read_shape(table);
  table.finish();
  return region;
}

MaterialRegion read_material_region(TomlTable& table, bool rigid) {
  const bool file = table.has("elements");
  if (count_shapes(table) + file != 1) {
    table.fail("", "has not exactly one of half_space, box, ball, group and elements",
               std::string("give ") + kShapes + ", or elements = \"values.csv\"");
  }
  if (file) return {table.path("elements"), {}};
  MaterialRegion region{read_shape(table), {}};
  for (const auto& [key, value, range] : material_keys(region.values)) {
    if (!table.has(key)) continue;
    if (rigid && key != std::string("density")) {
      table.fail(key, "is for soft bodies", "leave it out, or leave material.rigid out");
    }
    *value = table.number(key, range);
  }
  const MaterialValues& given = region.values;
  if (!given.youngs_modulus && !given.poisson_ratio && !given.density) {
    table.fail("", "changes nothing",
               "give one of youngs_modulus, poisson_ratio and density, or leave the table out");
  }
  return region;
}

std::vector<MaterialRegion> read_material_regions(TomlTable& root, bool rigid) {
  std::vector<MaterialRegion> regions;
  for (TomlTable& table : root.tables("region")) {
    regions.push_back(read_material_region(table, rigid));
    table.finish();
  }
  return regions;
}

std::optional<Region> read_clamped(TomlTable& root, Support support) {
  if (support == Support::kFixed) return read_region(root.table("support", true));
  if (root.has("support")) {
    root.fail("support", "is there but the body is floating",
              "set response.support = \"fixed\" or leave the table out");
  }
  return std::nullopt;
}

void read_soft_body(TomlTable& root, PrecomputeConfig& config) {
  config.material = read_material(root.table("material", true));
  config.regions = read_material_regions(root, false);
  config.response = read_response(root.table("response"));
  config.modes = read_modes(root.table("modes"));
  config.support = read_clamped(root, config.response.support);
  config.time_stepping = read_time_stepping(root.table("time_stepping"), config.response.dt);
}

void refuse_keys_of_soft_bodies(const TomlTable& table, std::initializer_list<const char*> keys) {
  for (const char* key : keys) {
    if (!table.has(key)) continue;
    table.fail(key, "is for soft bodies", "leave it out, or leave material.rigid out");
  }
}

void read_rigid_body(TomlTable& root, PrecomputeConfig& config) {
  refuse_keys_of_soft_bodies(root, {"modes", "support", "time_stepping"});
  TomlTable material = root.table("material", true);
  refuse_keys_of_soft_bodies(
      material, {"youngs_modulus", "poisson_ratio", "rayleigh_alpha", "rayleigh_beta"});
  config.rigid = material.boolean("rigid", true);
  config.material.density = material.number("density", lab::kDensity);
  material.finish();
  config.regions = read_material_regions(root, true);
  TomlTable response = root.table("response");
  refuse_keys_of_soft_bodies(response, {"steps", "method", "storage", "precision"});
  config.response.dt = response.number("dt", lab::kStepTime, config.response.dt);
  config.response.steps = 1;
  config.response.support = read_support(response);
  response.finish();
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
  TomlTable mesh = root.table("mesh", true);
  const bool rigid = root.table("material", true).boolean("rigid", false);
  // A rigid body gains nothing from more nodes, and contacts between objects cost more with them.
  config.mesh = read_mesh_config(std::move(mesh), rigid ? 1 : config.mesh.order);
  if (rigid) {
    read_rigid_body(root, config);
  } else {
    read_soft_body(root, config);
  }
  if (root.has("display")) {
    config.display = read_display_config(root.table("display"), config.mesh.unit);
  }
  root.finish();
  return config;
}

PrecomputeConfig load_config(const std::filesystem::path& path) {
  return read_config(TomlTable::parse_file(path), path.string());
}

}  // namespace irdm::precompute
