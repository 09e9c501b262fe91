#include <algorithm>
#include <sstream>

#include "precompute/check/check_model.hpp"
#include "precompute/check/static_reference.hpp"
#include "precompute/precompute.hpp"
#include "tests/check/dense_file.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace irdm;
using namespace irdm::precompute;
using irdm::test::DenseCube;

namespace {

Report checked(const DenseCube& cube, const CheckOptions& options = {}) {
  const irdm::test::TemporaryFolder folder;
  cube.write(folder.path() / "cube.h5");
  std::ostringstream ignored;
  return check_model(folder.path() / "cube.h5", options, Console{ignored, false});
}

Verdict verdict(const Report& report, const std::string& name) {
  const auto line =
      std::find_if(report.begin(), report.end(), [&](const Line& one) { return one.name == name; });
  INFO(format_report(report));
  REQUIRE(line != report.end());
  return line->verdict;
}

}  // namespace

TEST_CASE("R of a floating cube passes every check") {
  const Report report = checked(DenseCube());
  INFO(format_report(report));
  CHECK(failed_lines(report).empty());
  for (const char* name : {"checksum", "reciprocity", "momentum", "static compliance", "decay at T",
                           "stable force", "stiffness in a step"}) {
    CHECK(verdict(report, name) == Verdict::kOk);
  }
}

TEST_CASE("a model of which modes are left out passes, unless what they add could give energy") {
  const irdm::test::TemporaryFolder folder;
  const auto path = folder.path() / "cube.h5";
  std::ostringstream ignored;
  const Console console{ignored, false};
  PrecomputeConfig config;
  config.name = "cube";
  config.mesh.source = BoxConfig{Vector3::Constant(0.12), {4, 4, 4}};
  config.mesh.order = 1;
  config.material = {2000.0, 0.4, 110.0, 8.0, 2e-4};
  config.modes.count = 60;
  precompute_model(config, path, console);
  const Report report = check_model(path, {}, console);
  INFO(format_report(report));
  CHECK(failed_lines(report).empty());
  CHECK(verdict(report, "modes left out") != Verdict::kFail);
  CHECK(verdict(report, "static compliance") == Verdict::kOk);
  CHECK(verdict(report, "wave speed") == Verdict::kNone);

  Model model = read_model(path, ResponseKind::kModal);
  auto& response = std::get<ModalResponse>(model.response);
  for (std::size_t i = 0; i + 1 < response.residual.row_start.size(); ++i) {
    for (int k = response.residual.row_start[i]; k < response.residual.row_start[i + 1]; ++k) {
      const auto place = static_cast<std::size_t>(k);
      if (response.residual.nodes[place] == static_cast<int>(i)) continue;
      for (std::size_t e = 0; e < 9; ++e) response.residual.blocks[9 * place + e] *= 1.5F;
    }
  }
  ModelFileWriter writer(path);
  writer.write_description(model);
  writer.write_modal(response);
  writer.commit();
  CHECK(verdict(check_model(path, {}, console), "modes left out") == Verdict::kFail);
}

TEST_CASE("what cannot be looked at is not called ok") {
  DenseCube cube;
  CHECK(verdict(checked(cube), "wave speed") == Verdict::kNone);  // 2 cells an edge are too few
  cube.model.body.support = Support::kFixed;
  const Report report = checked(cube);
  CHECK(verdict(report, "momentum") == Verdict::kNone);
  CHECK(verdict(report, "static compliance") == Verdict::kNone);
}

TEST_CASE("a column that is scaled breaks reciprocity and the static compliance") {
  DenseCube cube;
  for (int s = 0; s < cube.model.steps; ++s) {
    for (int a = 0; a < cube.model.degrees_of_freedom(); ++a) cube.at(s, a, 20) *= 1.3;
  }
  const Report report = checked(cube);
  CHECK(verdict(report, "reciprocity") == Verdict::kFail);
}

TEST_CASE("rigid motion that is left in the columns fails by its momentum") {
  DenseCube cube;
  const StaticReference reference(cube.model);
  const Eigen::MatrixXd& rigid = reference.surface_rigid();
  const int motion = GENERATE(0, 4);
  // Symmetric, so that reciprocity does not see it; it comes and goes with the lowest mode.
  for (int s = 0; s < 100; ++s) {
    for (int b = 0; b < cube.model.degrees_of_freedom(); ++b) {
      for (int a = 0; a < cube.model.degrees_of_freedom(); ++a) {
        cube.at(s, a, b) += 1e-5 * rigid(a, motion) * rigid(b, motion);
      }
    }
  }
  const Report report = checked(cube);
  CHECK(verdict(report, "momentum") == Verdict::kFail);
  CHECK(verdict(report, "reciprocity") == Verdict::kOk);
}

TEST_CASE("a response of another material fails by its static compliance") {
  DenseCube cube;
  cube.model.material.youngs_modulus *= 1.5;
  CHECK(verdict(checked(cube), "static compliance") == Verdict::kFail);
}

TEST_CASE("a mode that grows gives out energy") {
  DenseCube cube;
  const auto& response = std::get<ModalResponse>(cube.model.response);
  const auto& shapes = std::get<RowMatrix<double>>(response.shapes);
  const double omega = response.angular_frequency(5);
  for (int s = 0; s < cube.model.steps; ++s) {
    const double t = (s + 1) * cube.model.dt;
    const double q = cube.model.dt / omega * std::sin(omega * t) * std::exp(1.0 * t);
    for (int b = 0; b < shapes.rows(); ++b) {
      for (int a = 0; a < shapes.rows(); ++a) {
        cube.at(s, a, b) += q * shapes(a, 5) * shapes(b, 5);
      }
    }
  }
  const Report report = checked(cube);
  CHECK(verdict(report, "passivity") == Verdict::kFail);
  CHECK(verdict(report, "decay at T") == Verdict::kFail);
  CHECK(verdict(report, "reciprocity") == Verdict::kOk);
}

TEST_CASE("a record that is cut short fails by what is left") {
  const Report report = checked(DenseCube(25));
  CHECK(verdict(report, "decay at T") == Verdict::kFail);
  CHECK(verdict(report, "passivity") == Verdict::kFail);
}

TEST_CASE("a response that comes a step late makes the force unstable") {
  DenseCube cube;
  for (int b = 0; b < cube.model.degrees_of_freedom(); ++b) {
    for (int a = 0; a < cube.model.degrees_of_freedom(); ++a) {
      const double first = cube.at(0, a, b);
      for (int s = cube.model.steps - 1; s > 0; --s) cube.at(s, a, b) = cube.at(s - 1, a, b);
      cube.at(0, a, b) = 0.05 * first;
    }
  }
  CHECK(verdict(checked(cube), "stable force") == Verdict::kFail);
}

TEST_CASE("a coupling that is wanted and not stable is a failure") {
  DenseCube cube;
  CheckOptions options;
  options.delay = 0.05;
  options.hand = {0.02, 0.05, 300.0};
  options.coupling = 1e6;
  CHECK(verdict(checked(cube, options), "virtual coupling") == Verdict::kFail);
  options.coupling = 0.0;
  CHECK(verdict(checked(cube, options), "virtual coupling") != Verdict::kOk);
}

TEST_CASE("a response that is not finite fails instead of passing unseen") {
  DenseCube cube;
  cube.at(30, 7, 7) = std::numeric_limits<double>::quiet_NaN();
  CHECK_FALSE(failed_lines(checked(cube)).empty());
}
