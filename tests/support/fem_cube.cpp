#include "tests/support/fem_cube.hpp"

#include <map>
#include <sstream>
#include <tuple>
#include <utility>

#include "precompute/compress/compress_model.hpp"
#include "precompute/precompute.hpp"
#include "tests/support/temporary_folder.hpp"

namespace irdm::test {
namespace {

auto key(const FemCube& cube) {
  return std::tie(cube.cells, cube.youngs_modulus, cube.rayleigh_alpha, cube.dt, cube.steps,
                  cube.poisson_ratio, cube.order, cube.modes);
}

precompute::PrecomputeConfig configuration(const FemCube& cube, ResponseKind kind) {
  precompute::PrecomputeConfig config;
  config.name = "test cube";
  config.mesh.source =
      precompute::BoxConfig{Vector3::Constant(0.12), {cube.cells, cube.cells, cube.cells}};
  config.mesh.order = cube.order;
  config.material = {cube.youngs_modulus, cube.poisson_ratio, 110.0, cube.rayleigh_alpha, 2e-4};
  if (cube.modes > 0) config.modes.count = cube.modes;
  config.response.dt = cube.dt;
  config.response.steps = cube.steps;
  config.response.storage =
      kind == ResponseKind::kModal ? precompute::Storage::kModal : precompute::Storage::kDense;
  return config;
}

}  // namespace

bool FemCube::operator<(const FemCube& other) const {
  return key(*this) < key(other);
}

std::shared_ptr<const Model> fem_cube(const FemCube& cube, ResponseKind kind) {
  static std::map<std::pair<FemCube, ResponseKind>, std::shared_ptr<const Model>> made;
  std::shared_ptr<const Model>& model = made[{cube, kind}];
  if (model == nullptr) {
    const TemporaryFolder folder;
    std::ostringstream ignored;
    const precompute::Console console{ignored, false};
    auto path = folder.path() / "cube.h5";
    precompute::precompute_model(configuration(cube, kind), path, console);
    if (kind == ResponseKind::kCompressed) {
      const auto dense = std::exchange(path, folder.path() / "compressed.h5");
      precompute::compress_model(dense, path, folder.path() / "part", {.error = 0.05}, console);
    }
    model = std::make_shared<const Model>(read_model(path, kind));
  }
  return model;
}

}  // namespace irdm::test
