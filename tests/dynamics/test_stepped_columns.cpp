#include <numeric>

#include "precompute/dynamics/stepped_columns.hpp"
#include "precompute/mesh/material_regions.hpp"
#include "precompute/mesh/surface.hpp"
#include "precompute/modal/dense_columns.hpp"
#include "precompute/modal/elastic_modes.hpp"
#include "tests/precompute/meshes.hpp"
#include "tests/support/catch.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::precompute;

namespace {

const Material kMaterial{2000.0, 0.3, 110.0, 8.0, 2e-4};
constexpr double kDt = 0.002;
constexpr int kIntervals = 40;

struct Cube {
  TetMesh mesh = test::box_mesh(Vector3(0.12, 0.12, 0.12), {3, 3, 3});
  std::vector<int> surface = extract_surface(mesh, "cube").nodes;

  DenseColumns<double> modal() const {
    const Eigen::VectorXd mass = lumped_mass(mesh, kMaterial);
    const ElasticModes modes = elastic_modes(assemble_stiffness(mesh, kMaterial), mesh.nodes, mass);
    return {modal_response(modes, surface, kMaterial), kDt, kIntervals};
  }
  SteppedColumns stepped(const TimeSteppingConfig& config) const {
    return {mesh, kMaterial, config, surface, kDt, kIntervals};
  }
};

TimeSteppingConfig equal_steps(Elasticity model, int steps_per_interval) {
  TimeSteppingConfig config;
  config.model = model;
  config.first_step = kDt / steps_per_interval;
  config.last_step = config.first_step;
  return config;
}

double difference(const RowMatrix<double>& a, const RowMatrix<double>& b) {
  return (a - b).cwiseAbs().maxCoeff() / b.cwiseAbs().maxCoeff();
}

TimeSteppingConfig read(const std::string& text) {
  return read_time_stepping(TomlTable::parse_text(text, "c.toml"), kDt);
}

}  // namespace

TEST_CASE("linear time stepping comes to the modal closed form with the square of the step",
          "[slow]") {
  const Cube cube;
  DenseColumns<double> modal = cube.modal();
  const std::vector<int> columns{0, 1, 2, 50, 76, 99, 121};
  std::vector<double> errors;
  for (const int steps : {20, 40, 80}) {
    const SteppedColumns stepped = cube.stepped(equal_steps(Elasticity::kLinear, steps));
    double error = 0.0;
    for (const int b : columns) {
      error = std::max(error, difference(stepped.column(b), modal.column(b)));
    }
    errors.push_back(error);
  }
  CAPTURE(errors);
  CHECK(errors[2] < 1e-3);
  CHECK(errors[0] / errors[1] == Approx(4.0).epsilon(0.15));
  CHECK(errors[1] / errors[2] == Approx(4.0).epsilon(0.1));
}

TEST_CASE("time stepping of a body with a stiff ball comes to its modal closed form", "[slow]") {
  const Cube cube;
  Material material = kMaterial;
  material.elements =
      element_materials(cube.mesh, material,
                        {{Region(BallRegion{Vector3(0.06, 0.06, 0.08), 0.045}),
                          {.youngs_modulus = 30000.0, .poisson_ratio = 0.4, .density = 200.0}}},
                        false, "cube");
  REQUIRE(report_regions(cube.mesh, material).size() == 2);
  const ElasticModes modes = elastic_modes(assemble_stiffness(cube.mesh, material), cube.mesh.nodes,
                                           lumped_mass(cube.mesh, material));
  DenseColumns<double> modal(modal_response(modes, cube.surface, material), kDt, kIntervals);
  std::vector<double> errors;
  for (const int steps : {40, 80}) {
    const SteppedColumns stepped(cube.mesh, material, equal_steps(Elasticity::kLinear, steps),
                                 cube.surface, kDt, kIntervals);
    errors.push_back(difference(stepped.column(76), modal.column(76)));
  }
  CAPTURE(errors);
  CHECK(errors[1] < 1e-3);
  CHECK(errors[0] / errors[1] == Approx(4.0).epsilon(0.15));
  const SteppedColumns corotational(cube.mesh, material, equal_steps(Elasticity::kCorotational, 80),
                                    cube.surface, kDt, kIntervals);
  CHECK(difference(corotational.column(76), modal.column(76)) < 1e-3);
}

TEST_CASE("corotational columns come to the linear ones as the force goes to zero") {
  const Cube cube;
  const RowMatrix<double> linear = cube.stepped(equal_steps(Elasticity::kLinear, 10)).column(4);
  std::vector<double> errors;
  for (const double force : {0.1, 0.01, 0.001}) {
    TimeSteppingConfig config = equal_steps(Elasticity::kCorotational, 10);
    config.force = force;
    errors.push_back(difference(cube.stepped(config).column(4), linear));
  }
  CAPTURE(errors);
  CHECK(errors[0] > 1e-4);
  CHECK(errors[0] / errors[1] == Approx(10.0).epsilon(0.3));
  CHECK(errors[1] / errors[2] == Approx(10.0).epsilon(0.1));
  CHECK(difference(cube.stepped(equal_steps(Elasticity::kCorotational, 10)).column(4), linear) <
        1e-4);
}

// Strains of 1e-8 must not drown in the rounding of a deformation gradient near one.
TEST_CASE("a very small force on a nearly incompressible body is solved") {
  Cube cube;
  Material rubbery = kMaterial;
  rubbery.poisson_ratio = 0.49;
  TimeSteppingConfig config;
  config.first_step = 1e-4;
  config.last_step = kDt;
  config.force = 1e-8;
  const SteppedColumns stepped(cube.mesh, rubbery, config, cube.surface, kDt, 100);
  config.model = Elasticity::kLinear;
  const SteppedColumns linear(cube.mesh, rubbery, config, cube.surface, kDt, 100);
  for (const int b : {0, 50}) {
    CHECK(difference(stepped.column(b), linear.column(b)) < 1e-6);
  }
}

TEST_CASE("the default schedule stays near the closed form") {
  const Cube cube;
  const SteppedColumns stepped = cube.stepped(read(""));
  const RowMatrix<double> exact = cube.modal().column(7);
  CHECK(difference(stepped.column(7), exact) < 0.02);
}

TEST_CASE("steps double after every `hold` intervals and divide the interval") {
  CHECK(step_schedule(read("hold = 2"), kDt, 12) ==
        std::vector{20, 20, 10, 10, 5, 5, 3, 3, 2, 2, 1, 1});
  CHECK(step_schedule(read("first_step = 5e-4\nlast_step = 0.001\nhold = 1"), kDt, 4) ==
        std::vector{4, 2, 2, 2});
  const TimeSteppingConfig odd = read_time_stepping(TomlTable::parse_text("", "c.toml"), 0.00125);
  CHECK(step_schedule(odd, 0.00125, 1) == std::vector{13});
}

TEST_CASE("time stepping configuration has defaults and takes every documented word") {
  const TimeSteppingConfig config = read("");
  CHECK(config.model == Elasticity::kCorotational);
  CHECK(config.first_step == Approx(1e-4));
  CHECK(config.last_step == kDt);
  CHECK(config.hold == 10);
  CHECK(config.force == 0.0);
  CHECK(config.rotation_weights == RotationWeights::kMass);
  CHECK(read("model = \"linear\"").model == Elasticity::kLinear);
  CHECK(read("rotation_weights = \"none\"").rotation_weights == RotationWeights::kNone);
  CHECK(read("force = 0.5").force == 0.5);
}

TEST_CASE("time stepping configuration refuses each bad entry") {
  const auto refused = [](const std::string& text, const std::string& message) {
    CAPTURE(text);
    CHECK_THROWS_WITH(read(text), ContainsSubstring(message) && ContainsSubstring("c.toml"));
  };
  refused("model = \"plastic\"", "corotational | linear");
  refused("first_step = 0", "first_step is 0");
  refused("first_step = -1e-4", "first_step is -");
  refused("first_step = nan", "first_step is nan");
  refused("first_step = 3e-4", "first_step does not divide response.dt");
  refused("first_step = 0.004", "first_step is longer than response.dt");
  refused("first_step = 1e-9", "too short");
  refused("last_step = 0.0015", "last_step does not divide response.dt");
  refused("last_step = 5e-5", "last_step is shorter than first_step");
  refused("last_step = 0.004", "last_step is longer than response.dt");
  refused("hold = 0", "hold is 0");
  refused("hold = 1.5", "hold is not a whole number");
  refused("force = 0", "force is 0");
  refused("force = -1", "force is -1");
  refused("force = inf", "force is inf");
  refused("rotation_weights = \"volume\"", "mass | none");
  refused("typo = 1", "typo is not a known key");
}
