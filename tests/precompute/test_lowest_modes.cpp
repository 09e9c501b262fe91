// The lowest modes by Lanczos against LAPACK's full set, and what they come from against closed
// forms.

#include "common/error.hpp"
#include "precompute/mesh/region.hpp"
#include "precompute/modal/driving_spectrum.hpp"
#include "precompute/modal/fingertip.hpp"
#include "precompute/modal/lowest_modes.hpp"
#include "tests/precompute/discrete.hpp"
#include "tests/precompute/meshes.hpp"
#include "tests/support/catch.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::precompute;
using irdm::test::Discrete;

namespace {

const Material kLowestMaterial{2000.0, 0.4, 110.0, 8.0, 2e-4};
const HalfSpace kLeft{Vector3::Zero(), Vector3(1, 0, 0)};

Discrete lowest_box() {
  return Discrete(test::box_mesh(Vector3(0.12, 0.08, 0.10), {4, 3, 3}), kLowestMaterial);
}

ElasticModes all_modes(const Discrete& body, const std::vector<int>& clamped) {
  return clamped.empty() ? elastic_modes(body.stiffness, body.mesh.nodes, body.mass)
                         : fixed_modes(body.stiffness, body.mass, clamped);
}

}  // namespace

TEST_CASE("lowest modes are those of the full set, free and fixed") {
  const Discrete body = lowest_box();
  const std::vector<int> clamped =
      GENERATE_COPY(std::vector<int>{}, nodes_in(body.mesh, kLeft, "box"));
  const ElasticModes all = all_modes(body, clamped);
  const ElasticStatics statics(body.stiffness, body.mesh.nodes, body.mass, clamped);
  CHECK(statics.elastic_modes() == all.angular_frequency.size());
  constexpr int kCount = 40;
  const ElasticModes lowest = lowest_modes(statics, kCount);
  REQUIRE(lowest.angular_frequency.size() == kCount);
  const Eigen::VectorXd expected = all.angular_frequency.head(kCount);
  CHECK((lowest.angular_frequency - expected).cwiseQuotient(expected).cwiseAbs().maxCoeff() < 1e-9);
  // Mass-normalised, and within the span of as many of the full set: all of each one's norm is
  // there.
  const Eigen::MatrixXd momentum = body.mass3.asDiagonal() * lowest.shapes;
  CHECK((lowest.shapes.transpose() * momentum - Eigen::MatrixXd::Identity(kCount, kCount)).norm() <
        1e-9);
  const Eigen::MatrixXd overlap = all.shapes.leftCols(kCount).transpose() * momentum;
  CHECK(overlap.colwise().squaredNorm().minCoeff() > 1.0 - 1e-9);
  if (clamped.empty()) {
    CHECK((body.rigid.transpose() * momentum).cwiseAbs().maxCoeff() < 1e-12);
  } else {
    for (const int node : clamped) CHECK(lowest.shapes.middleRows<3>(3 * node).isZero(0.0));
  }
}

TEST_CASE("lowest modes are the same bits every time") {
  const Discrete body = lowest_box();
  const ElasticStatics statics(body.stiffness, body.mesh.nodes, body.mass, {});
  const ElasticModes once = lowest_modes(statics, 12);
  const ElasticModes again = lowest_modes(statics, 12);
  CHECK(once.angular_frequency == again.angular_frequency);
  CHECK(once.shapes == again.shapes);
}

TEST_CASE("bodies with motions without energy besides the rigid ones have no lowest modes") {
  TetMesh mesh = test::one_tet();  // two tetrahedra that hang on one edge
  mesh.nodes.conservativeResize(6, 3);
  mesh.nodes.row(4) << -1, 0, 0;
  mesh.nodes.row(5) << 0, -1, 0;
  mesh.tets.conservativeResize(2, 4);
  mesh.tets.row(1) << 0, 4, 5, 3;
  const Discrete body(mesh, kLowestMaterial);
  const auto lowest = [&] {
    return lowest_modes(ElasticStatics(body.stiffness, body.mesh.nodes, body.mass, {}), 3);
  };
  CHECK_THROWS_WITH(
      lowest(), ContainsSubstring("mesh") && ContainsSubstring("hang on a single node or edge"));
}

TEST_CASE("a rod without transverse contraction is pulled by F L / (E A)") {
  const Vector3 size(0.3, 0.1, 0.1);
  const Discrete rod(test::box_mesh(size, {6, 2, 2}), {2000.0, 0.0, 110.0, 8.0, 2e-4});
  const ElasticStatics statics(rod.stiffness, rod.mesh.nodes, rod.mass,
                               nodes_in(rod.mesh, kLeft, "rod"));
  // The forces of a uniform tension on the end: those that strain alone asks for.
  Eigen::VectorXd stretched(rod.mass3.size());
  for (int i = 0; i < rod.mesh.node_count(); ++i) {
    stretched.segment<3>(3 * i) = Vector3(rod.mesh.nodes(i, 0) / size.x(), 0, 0);
  }
  Eigen::VectorXd force = rod.stiffness * stretched;
  double pull = 0.0;
  for (int i = 0; i < rod.mesh.node_count(); ++i) {
    if (rod.mesh.nodes(i, 0) < size.x() - 1e-9) force.segment<3>(3 * i).setZero();
    pull += force(3 * i);
  }
  const double area = size.y() * size.z();
  CHECK(pull == Approx(2000.0 * area / size.x()).epsilon(1e-12));
  const Eigen::VectorXd u = statics.displacement(force / pull);
  const double expected = size.x() / (2000.0 * area);
  CHECK((u - expected * stretched).cwiseAbs().maxCoeff() < 1e-10 * expected);
}

TEST_CASE("static displacement of a free body is that of an independent inertia-relief solve") {
  const Discrete body = lowest_box();
  const ElasticStatics statics(body.stiffness, body.mesh.nodes, body.mass, {});
  Eigen::MatrixXd force = Eigen::MatrixXd::Zero(body.mass3.size(), 2);
  force(5, 0) = 1.0;
  force(3 * test::node_at(body.mesh, Vector3(0.12, 0.04, 0.05)) + 1, 1) = 2.0;
  const Eigen::MatrixXd u = statics.displacement(force);
  for (int k = 0; k < 2; ++k) {
    const Eigen::VectorXd expected =
        inertia_relief(body, force.col(k), test::node_at(body.mesh, Vector3(0, 0, 0)),
                       test::node_at(body.mesh, Vector3(0.12, 0, 0)),
                       test::node_at(body.mesh, Vector3(0, 0.08, 0)));
    CHECK((u.col(k) - expected).norm() < 1e-8 * expected.norm());
  }
}

TEST_CASE("a driving spectrum answers as all modes do") {
  const Discrete body = lowest_box();
  const ElasticModes all = all_modes(body, {});
  const ElasticStatics statics(body.stiffness, body.mesh.nodes, body.mass, {});
  Eigen::MatrixXd load = Eigen::MatrixXd::Zero(body.mass3.size(), 2);
  load(0, 0) = 1.0;
  load(3 * test::node_at(body.mesh, Vector3(0.12, 0.04, 0.05)), 1) = 1.0;
  const double dt = 0.002;
  const auto spectra = driving_spectra(statics, load, 80);
  for (int k = 0; k < 2; ++k) {
    const Eigen::VectorXd share = all.shapes.transpose() * load.col(k);
    const DrivingSpectrum exact{all.angular_frequency, share.cwiseAbs2()};
    const Eigen::VectorXd expected = driving_response(exact, kLowestMaterial, dt, press_steps(dt));
    const Eigen::VectorXd found = driving_response(spectra[static_cast<std::size_t>(k)],
                                                   kLowestMaterial, dt, press_steps(dt));
    CHECK((found - expected).cwiseAbs().maxCoeff() < 1e-5 * expected.cwiseAbs().maxCoeff());
    CHECK(found.sum() == Approx(expected.sum()).epsilon(1e-6));
    CHECK(press_error(expected, found, dt) < 1e-5);
    // More steps come closer: nothing but the quadrature is between the two.
    const auto coarse = driving_spectra(statics, load, 20)[static_cast<std::size_t>(k)];
    CHECK(press_error(expected, driving_response(coarse, kLowestMaterial, dt, press_steps(dt)),
                      dt) > 10.0 * press_error(expected, found, dt));
  }
}

TEST_CASE("what is pressed in without delay takes the force of its compliance") {
  const double dt = 0.002;
  Eigen::VectorXd at_once = Eigen::VectorXd::Zero(press_steps(dt));
  at_once(0) = 0.02;
  const Eigen::VectorXd force = press_force(at_once, dt);
  CHECK(force(press_steps(dt) - 1) == Approx(1.0 / 0.02));
  CHECK(force(press_steps(dt) / 4 - 1) == Approx(0.5 / 0.02));
  CHECK(press_error(at_once, 2.0 * at_once, dt) == Approx(0.5));
  CHECK(press_error(at_once, at_once, dt) == 0.0);
}
