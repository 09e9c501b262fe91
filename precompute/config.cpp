#include "precompute/config.hpp"

#include <cmath>
#include <map>

#include "common/error.hpp"

namespace irdm::precompute {
namespace {

constexpr int kMaxCells = 100;
constexpr int kMaxSteps = 1'000'000;

BoxConfig read_box(TomlTable table) {
  BoxConfig box;
  const std::vector<double> size = table.numbers("size", 3, above(0));
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

MeshConfig read_mesh(TomlTable table) {
  MeshConfig mesh;
  if (table.has("box") == table.has("file")) {
    table.fail("", table.has("box") ? "has both box and file" : "has neither box nor file",
               "give one of box = { size = [..], cells = [..] } and file = \"name\"");
  }
  if (table.has("box")) {
    mesh.source = read_box(table.table("box"));
  } else {
    mesh.source = table.path("file");
  }
  mesh.order = table.integer("order", 1, 2, mesh.order);
  if (mesh.order != 1) {
    table.fail("order", "is 2", "only 1 (linear tetrahedra) is available in this version");
  }
  table.finish();
  return mesh;
}

Material read_material(TomlTable table) {
  Material material;
  material.youngs_modulus = table.number("youngs_modulus", above(0));
  material.poisson_ratio = table.number(
      "poisson_ratio",
      {.lowest = -1.0, .highest = 0.5, .lowest_included = false, .highest_included = false});
  material.density = table.number("density", above(0));
  material.rayleigh_alpha = table.number("rayleigh_alpha", at_least(0), 8.0);
  material.rayleigh_beta = table.number("rayleigh_beta", at_least(0), 2e-4);
  table.finish();
  return material;
}

ResponseConfig read_response(TomlTable table) {
  ResponseConfig response;
  response.dt =
      table.number("dt", {.lowest = 0.0, .highest = 1.0, .lowest_included = false}, response.dt);
  response.steps = table.integer("steps", 1, kMaxSteps, response.steps);
  response.method = method_from_word(table.choice("method", {"modal", "time-stepping"}, "modal"));
  response.storage =
      storage_from_word(table.choice("storage", {"modal", "dense", "both"}, "modal"));
  response.precision = table.choice("precision", {"single", "double"}, "single") == "single"
                           ? Precision::kSingle
                           : Precision::kDouble;
  if (table.choice("support", {"floating", "fixed"}, "floating") != "floating") {
    table.fail("support", "is 'fixed'", "only \"floating\" is available in this version");
  }
  table.finish();
  return response;
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
  config.time_stepping = read_time_stepping(root.table("time_stepping"), config.response.dt);
  root.finish();
  return config;
}

PrecomputeConfig load_config(const std::filesystem::path& path) {
  return read_config(TomlTable::parse_file(path), path.string());
}

}  // namespace irdm::precompute
