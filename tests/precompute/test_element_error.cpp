#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "precompute/config.hpp"
#include "precompute/mesh/make_mesh.hpp"
#include "precompute/mesh/mesh_check.hpp"
#include "precompute/modal/element_error.hpp"
#include "precompute/modal/modal_method.hpp"
#include "tests/precompute/program_run.hpp"
#include "tests/support/catch.hpp"

namespace irdm::precompute {
namespace {

using Catch::Matchers::ContainsSubstring;
using irdm::test::kProgramMaterial;
using irdm::test::ProgramRun;
using irdm::test::with_words;

constexpr double kThinThickness = 5e-4;  // [m], of a plate and a rod of 10 cm
constexpr double kThinSide = 0.1;
const Material kThinMaterial{2e6, 0.3, 1000.0, 0.0, 0.0};

TetMesh meshed_box(const Vector3& size, const std::array<int, 3>& cells, int order) {
  MeshConfig config;
  config.source = BoxConfig{size, cells};
  config.order = order;
  return make_mesh(config).mesh;
}

TetMesh thin_plate(int cells, int order) {
  return meshed_box({kThinSide, kThinSide, kThinThickness}, {cells, cells, 1}, order);
}

TetMesh thin_rod(int cells, int order) {
  return meshed_box({kThinSide, kThinThickness, kThinThickness}, {cells, 1, 1}, order);
}

// Free square plate, nu = 0.3 (Leissa, Vibration of plates, NASA SP-160, 1969): 13.49.
double thin_plate_frequency() {
  const double bending = kThinMaterial.youngs_modulus * std::pow(kThinThickness, 3) /
                         (12.0 * (1.0 - kThinMaterial.poisson_ratio * kThinMaterial.poisson_ratio));
  return 13.49 / (2.0 * std::numbers::pi * kThinSide * kThinSide) *
         std::sqrt(bending / (kThinMaterial.density * kThinThickness));
}

// Free Euler-Bernoulli beam: 22.37.
double thin_rod_frequency() {
  return 22.373 / (2.0 * std::numbers::pi * kThinSide * kThinSide) * kThinThickness *
         std::sqrt(kThinMaterial.youngs_modulus / (12.0 * kThinMaterial.density));
}

// The estimate is within a factor of 2 of the truth.
void check_stiffness_estimate(const ElementError& error, double theory) {
  const double truth = std::pow(error.frequency / theory, 2);
  CAPTURE(error.frequency, error.finer_frequency, theory);
  CHECK(truth > 10.0);
  CHECK(error.stiffness_ratio() > 0.5 * truth);
  CHECK(error.stiffness_ratio() < 2.0 * truth);
  CHECK(error.is_large());
}

}  // namespace

TEST_CASE("a split mesh is the same body in eight times the tetrahedra") {
  const Vector3 size(0.12, 0.1, 0.08);
  const TetMesh quadratic = meshed_box(size, {2, 2, 1}, 2);
  const TetMesh split = split_mesh(quadratic);
  CHECK(split.nodes == quadratic.nodes);
  CHECK(split.order() == 1);
  REQUIRE(split.tet_count() == 8 * quadratic.tet_count());
  CHECK_NOTHROW(check_mesh(split, "split"));  // conforming, positive volumes
  for (int e = 0; e < quadratic.tet_count(); ++e) {
    double volume = 0.0;
    for (int k = 0; k < 8; ++k) {
      CHECK(signed_volume(split, 8 * e + k) == Approx(signed_volume(quadratic, e) / 8.0));
      volume += signed_volume(split, 8 * e + k);
    }
    CHECK(volume == Approx(signed_volume(quadratic, e)));
  }
}

TEST_CASE("linear elements of a thin plate are found hundreds of times too stiff") {
  const auto error = element_error(thin_plate(10, 1), kThinMaterial);
  REQUIRE(error);
  CHECK(error->finer_frequency == Approx(thin_plate_frequency()).epsilon(0.1));
  check_stiffness_estimate(*error, thin_plate_frequency());
}

TEST_CASE("linear elements of a thin rod are found many times too stiff") {
  const auto error = element_error(thin_rod(20, 1), kThinMaterial);
  REQUIRE(error);
  CHECK(error->finer_frequency == Approx(thin_rod_frequency()).epsilon(0.1));
  check_stiffness_estimate(*error, thin_rod_frequency());
}

TEST_CASE("a plate and a rod of quadratic elements bend as theory says", "[slow]") {
  const auto flat = element_error(thin_plate(8, 2), kThinMaterial);
  REQUIRE(flat);
  CHECK(flat->frequency == Approx(thin_plate_frequency()).epsilon(0.1));
  CHECK(!flat->is_large());
  const auto thin = element_error(thin_rod(20, 2), kThinMaterial);
  REQUIRE(thin);
  CHECK(thin->frequency == Approx(thin_rod_frequency()).epsilon(0.1));
  CHECK(!thin->is_large());
}

TEST_CASE("too few quadratic elements are warned about as well", "[slow]") {
  const auto error = element_error(thin_plate(1, 2), kThinMaterial);
  REQUIRE(error);
  CAPTURE(error->frequency, error->finer_frequency);
  CHECK(error->is_large());
  const double truth = std::pow(error->frequency / thin_plate_frequency(), 2);
  CHECK(error->stiffness_ratio() > 0.5 * truth);
  CHECK(error->stiffness_ratio() < 2.0 * truth);
}

TEST_CASE("ordinary bodies are not warned about, with one material or several") {
  const auto cube = element_error(meshed_box(Vector3::Constant(0.12), {2, 2, 2}, 2), kThinMaterial);
  REQUIRE(cube);
  CHECK(!cube->is_large());
  const TetMesh mesh = meshed_box(Vector3::Constant(0.12), {2, 2, 2}, 2);
  Material two = kThinMaterial;
  for (int e = 0; e < mesh.tet_count(); ++e) {
    const bool stiff = mesh.position(mesh.tets(e, 0)).x() > 0.06;
    two.elements.youngs_modulus.push_back(stiff ? 4e6 : 1e6);
    two.elements.poisson_ratio.push_back(0.3);
    two.elements.density.push_back(1000.0);
    two.elements.region.push_back(stiff ? 1 : 0);
  }
  const auto both = element_error(mesh, two);
  REQUIRE(both);
  CHECK(!both->is_large());
}

TEST_CASE("a mesh is not compared with a finer one that takes too long") {
  const TetMesh fine = meshed_box(Vector3::Constant(0.12), {12, 12, 12}, 2);
  CHECK(!element_error(fine, kThinMaterial));
  const ElementReport report = report_elements(fine, kThinMaterial);
  CHECK(!report.compared);
  CHECK(!report.warning);
  CHECK_THAT(report.found, ContainsSubstring(std::to_string(most_finer_unknowns()) + " unknowns"));
}

TEST_CASE("how much is too stiff is said in per cent, or as a factor") {
  CHECK(stiffness_text(1.17) == "about 17 % too stiff");
  CHECK(stiffness_text(75.4) == "about 75 times too stiff");
  CHECK(stiffness_text(5508.0) == "about 5500 times too stiff");
  CHECK(stiffness_text(2.31) == "about 2.3 times too stiff");
  CHECK(stiffness_text(0.8) == "about 20 % too soft");
  CHECK(stiffness_text(0.25) == "about 4 times too soft");
}

TEST_CASE(
    "linear tetrahedra lock from Poisson's ratio 0.45 on, by as much as on the paper's grid") {
  CHECK(locking_ratio(0.3) == Approx(1.09).epsilon(0.01));
  CHECK(locking_ratio(0.45) == Approx(1.17).epsilon(0.01));
  CHECK(locking_ratio(0.49) == Approx(1.56).epsilon(0.01));
  Material material = kThinMaterial;
  CHECK(!locking_hint(1, material));
  material.poisson_ratio = 0.49;
  CHECK(!locking_hint(2, material));
  CHECK_THAT(locking_hint(1, material).value(), ContainsSubstring("0.49") &&
                                                    ContainsSubstring("about 56 % too stiff") &&
                                                    ContainsSubstring("set mesh.order = 2"));
}

TEST_CASE("precompute and check warn of a thin body of linear elements, and not by default",
          "[slow]") {
  ProgramRun run;
  const std::string thin = "[mesh]\nbox = { size = [0.05, 0.05, 0.002], cells = [6, 6, 1] }\n";
  run.write("c.toml", thin + "order = 1\n" + kProgramMaterial);
  run.start("c.toml -o made/model.h5");
  REQUIRE(run.status == 0);
  CHECK_THAT(run.err, ContainsSubstring("warning: lowest frequency of the free body") &&
                          ContainsSubstring("times too stiff; set mesh.order = 2"));
  run.start("check made/model.h5");
  CHECK_THAT(run.out, ContainsSubstring("times too stiff; set mesh.order = 2"));
  run.write("c.toml", thin + kProgramMaterial);
  run.start("c.toml -o made/model.h5");
  REQUIRE(run.status == 0);
  CHECK_THAT(run.err, !ContainsSubstring("too stiff"));
  CHECK_THAT(run.out, ContainsSubstring("order of the elements             2") &&
                          ContainsSubstring("elements: lowest frequency of the free body"));
}

TEST_CASE("modes are left out by default only where all would take over a minute") {
  PrecomputeConfig config;
  CHECK(takes_fewer_modes(config, 7000));
  CHECK(!takes_fewer_modes(config, 4920));
  config.response.storage = Storage::kBoth;
  CHECK(!takes_fewer_modes(config, 7000));
  config.response.storage = Storage::kModal;
  config.rigid = true;
  CHECK(!takes_fewer_modes(config, 7000));
  config.rigid = false;
  config.modes.count = 9;
  CHECK(!takes_fewer_modes(config, 7000));
  config.modes = {};
  config.modes.error = 0.0;
  CHECK(!takes_fewer_modes(config, 7000));
}

TEST_CASE("the program says that it leaves out modes, unless the configuration chose", "[slow]") {
  ProgramRun run;
  const std::string body =
      "[mesh]\nbox = { size = [0.2, 0.2, 0.05], cells = [24, 24, 5] }\norder = 1\n" +
      kProgramMaterial + "[response]\nsteps = 50\n";
  const std::string said = "so modes.error = 0.01 by default";
  run.write("c.toml", body);
  run.start("c.toml -o made/model.h5");
  INFO(run.err);
  REQUIRE(run.status == 0);
  CHECK_THAT(run.out, ContainsSubstring("modes: all of them would take about ") &&
                          ContainsSubstring(said) &&
                          ContainsSubstring("modes.error = 0 computes all") &&
                          ContainsSubstring("error of force under a fingertip"));
  run.write("c.toml", body + "[modes]\ncount = 20\n");
  run.start("c.toml -o made/model.h5");
  REQUIRE(run.status == 0);
  CHECK_THAT(run.out, !ContainsSubstring(said) &&
                          ContainsSubstring("elastic modes                     20\n"));
}

}  // namespace irdm::precompute
