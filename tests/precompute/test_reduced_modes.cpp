// Some of the modes and what the others add, against all of them.
#include <cmath>
#include <numbers>
#include <sstream>

#include "precompute/config.hpp"
#include "precompute/mesh/surface.hpp"
#include "precompute/modal/driving_spectrum.hpp"
#include "precompute/modal/fingertip.hpp"
#include "precompute/modal/modal_method.hpp"
#include "precompute/modal/reduced_modes.hpp"
#include "precompute/modal/residual_compliance.hpp"
#include "tests/precompute/discrete.hpp"
#include "tests/precompute/meshes.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;
using namespace irdm::precompute;
using irdm::test::Discrete;

namespace {

struct Cube {
  Discrete body{test::box_mesh(Vector3::Constant(0.12), {5, 5, 5}),
                {2000.0, 0.4, 110.0, 8.0, 2e-4}};
  Model model;
  std::ostringstream ignored;
  Console console{ignored, false};

  Cube() {
    model.material = {2000.0, 0.4, 110.0, 8.0, 2e-4};
    Surface surface = extract_surface(body.mesh, "cube");
    model.mesh.nodes = body.mesh.nodes.rowwise() - Eigen::RowVector3d::Constant(0.06);
    model.mesh.tets = body.mesh.tets;
    model.mesh.node_mass = body.mass;
    model.mesh.surface_nodes = surface.nodes;
    model.mesh.triangles = surface.triangles;
    model.dt = 0.002;
    model.steps = 100;
  }
  ModalResponse all() { return compute_modes(body.mesh, {}, model, console); }
  ModalResponse reduced(const ModesConfig& config, int threads = 2) {
    return compute_reduced_modes(body.mesh, {}, model, config, threads, console);
  }
};

Eigen::MatrixXd settled(const ModalResponse& modes) {
  const auto& shapes = std::get<RowMatrix<double>>(modes.shapes);
  return shapes * modes.angular_frequency.cwiseAbs2().cwiseInverse().asDiagonal() *
         shapes.transpose();
}

Eigen::MatrixXd assembled(const ResidualCompliance& residual) {
  const auto nodes = static_cast<Eigen::Index>(residual.row_start.size()) - 1;
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(3 * nodes, 3 * nodes);
  for (Eigen::Index i = 0; i < nodes; ++i) {
    for (int k = residual.row_start[static_cast<std::size_t>(i)];
         k < residual.row_start[static_cast<std::size_t>(i) + 1]; ++k) {
      const auto place = static_cast<std::size_t>(k);
      all.block<3, 3>(3 * i, 3 * residual.nodes[place]) =
          Eigen::Map<const Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>(residual.blocks.data() +
                                                                        9 * place)
              .cast<double>();
    }
  }
  return all;
}

}  // namespace

TEST_CASE("modes end smoothly: whole up to half of the cut-off, nothing there") {
  CHECK(kept_share(0.1, 2.0) == 1.0);
  CHECK(kept_share(1.0, 2.0) == 1.0);
  CHECK(kept_share(std::sqrt(2.5), 2.0) == Approx(0.5));
  CHECK(kept_share(2.0, 2.0) == 0.0);
}

TEST_CASE("modes and residual together have the static compliance of all modes", "[slow]") {
  Cube cube;
  ModesConfig config;
  config.count = 60;
  config.contact_radius = 0.2;  // everything is near
  const ModalResponse reduced = cube.reduced(config);
  const Eigen::MatrixXd expected = settled(cube.all());
  const Eigen::MatrixXd found = settled(reduced) + assembled(reduced.residual);
  CHECK((found - expected).cwiseAbs().maxCoeff() < 1e-6 * expected.cwiseAbs().maxCoeff());
  CHECK(reduced.residual.reduction.shape_error < 1e-6);
}

TEST_CASE("near a contact the static compliance is that of all modes, and gives no energy",
          "[slow]") {
  Cube cube;
  ModesConfig config;
  config.count = 60;
  config.contact_radius = GENERATE(0.012, 0.02);
  const ModalResponse reduced = cube.reduced(config);
  const ModeReduction& reduction = reduced.residual.reduction;
  const Eigen::MatrixXd residual = assembled(reduced.residual);
  CHECK(residual == residual.transpose());
  const Eigen::MatrixXd expected = settled(cube.all());
  const Eigen::MatrixXd found = settled(reduced) + residual;
  double largest = 0.0;
  for (int i = 0; i < cube.model.mesh.surface_node_count(); ++i) {
    for (int j = 0; j < cube.model.mesh.surface_node_count(); ++j) {
      const double apart =
          (cube.model.mesh.rest_position(i) - cube.model.mesh.rest_position(j)).norm();
      if (apart > reduction.residual_radius) {
        REQUIRE(residual.block<3, 3>(3 * i, 3 * j).isZero(0.0));
        continue;
      }
      Matrix3 difference = found.block<3, 3>(3 * i, 3 * j) - expected.block<3, 3>(3 * i, 3 * j);
      if (i == j) difference.diagonal().array() -= reduction.added_compliance;
      largest = std::max(largest, difference.cwiseAbs().maxCoeff());
    }
  }
  CHECK(largest < 1e-6 * expected.cwiseAbs().maxCoeff());
  const Eigen::VectorXd values =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(residual, Eigen::EigenvaluesOnly)
          .eigenvalues();
  CHECK(values(0) > -1e-6 * values(values.size() - 1));
}

TEST_CASE("what is added to the diagonal is what is lacking to be positive semidefinite",
          "[slow]") {
  Cube cube;
  ModesConfig config;
  config.count = 60;
  ResidualCompliance residual = cube.reduced(config).residual;
  for (float& value : residual.blocks) value = -value;  // as indefinite as can be
  const Eigen::MatrixXd all = assembled(residual);
  const double lowest =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(all, Eigen::EigenvaluesOnly).eigenvalues()(0);
  CHECK(needed_for_definiteness(residual) == Approx(-lowest).epsilon(1e-3));
}

TEST_CASE("the stated errors are those against all modes", "[slow]") {
  Cube cube;
  ModesConfig config;
  config.count = 80;
  const ModalResponse reduced = cube.reduced(config);
  const ModeReduction& reduction = reduced.residual.reduction;
  // The same fingertips, now with the modes of the full set.
  const ElasticStatics statics(cube.body.stiffness, cube.model.mesh.nodes, cube.body.mass, {});
  const FingertipReference reference(statics, cube.model, 0.015, {});
  const ModalResponse all = cube.all();
  const ReductionError none = reference.error(all);
  CHECK(none.force < 1e-5);  // of the quadrature
  CHECK(none.shape < 1e-9);
  CHECK(reduction.force_error > 1e-4);
  CHECK(reduction.force_error < 0.015);
  CHECK(reduction.shape_error < 0.15);
  ModalResponse without = reduced;
  without.residual = {};
  CHECK(reference.error(without).force > 10.0 * reduction.force_error);
}

TEST_CASE("modes are chosen by frequency and by error", "[slow]") {
  Cube cube;
  const ModalResponse all = cube.all();
  ModesConfig by_frequency;
  by_frequency.highest_frequency = 40.0;
  const auto below = (all.angular_frequency.array() <= 2.0 * std::numbers::pi * 40.0).count();
  const ModalResponse found = cube.reduced(by_frequency);
  CHECK(found.mode_count() == below);
  CHECK(found.residual.reduction.cut_off == Approx(all.angular_frequency(below)));
  ModesConfig by_error;
  by_error.error = 0.02;
  const ModalResponse enough = cube.reduced(by_error);
  CHECK(enough.residual.reduction.force_error < 0.025);  // and what is added to the diagonal
  ModesConfig fewer;
  fewer.count = 10;
  CHECK(cube.reduced(fewer).residual.reduction.force_error > enough.residual.reduction.force_error);
  ModesConfig bounded;
  bounded.error = 1e-4;
  bounded.most = 10;
  CHECK(cube.reduced(bounded).mode_count() == 10);
}

TEST_CASE("some of the modes and their residual are the same for any number of threads", "[slow]") {
  Cube cube;
  ModesConfig config;
  config.count = 20;
  const ModalResponse one = cube.reduced(config, 1);
  const ModalResponse three = cube.reduced(config, 3);
  CHECK(std::get<RowMatrix<double>>(one.shapes) == std::get<RowMatrix<double>>(three.shapes));
  CHECK(one.residual.blocks == three.residual.blocks);
  CHECK(one.residual.reduction.force_error == three.residual.reduction.force_error);
}

TEST_CASE("a fixed body's clamped nodes answer nothing, and the others as with all modes",
          "[slow]") {
  Cube cube;
  std::vector<int> clamped;
  for (int i = 0; i < cube.body.mesh.node_count(); ++i) {
    if (cube.body.mesh.nodes(i, 1) < 1e-9) clamped.push_back(i);
  }
  cube.model.body.support = Support::kFixed;
  ModesConfig config;
  config.count = 60;
  config.contact_radius = 0.2;
  const ModalResponse reduced =
      compute_reduced_modes(cube.body.mesh, clamped, cube.model, config, 2, cube.console);
  const Eigen::MatrixXd expected =
      settled(compute_modes(cube.body.mesh, clamped, cube.model, cube.console));
  const Eigen::MatrixXd found = settled(reduced) + assembled(reduced.residual);
  CHECK((found - expected).cwiseAbs().maxCoeff() < 1e-6 * expected.cwiseAbs().maxCoeff());
  CHECK(reduced.centrifugal.rows() == 0);

  const ModalResponse all = compute_modes(cube.body.mesh, clamped, cube.model, cube.console);
  const auto sag = [](const ModalResponse& modes) -> Eigen::MatrixXd {
    return std::get<RowMatrix<double>>(modes.shapes) *
           modes.angular_frequency.cwiseAbs2().cwiseInverse().asDiagonal() * modes.gravity;
  };
  CHECK(all.gravity_rest.rows() == 0);
  const Eigen::MatrixXd lacking = sag(all) - sag(reduced);
  CHECK(lacking.norm() > 1e-4 * sag(all).norm());
  CHECK((reduced.gravity_rest - lacking).norm() < 1e-7 * sag(all).norm());
  cube.model.body.support = Support::kFloating;
  CHECK(cube.all().gravity.rows() == 0);
}
