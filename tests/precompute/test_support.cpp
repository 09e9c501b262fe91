#include <Eigen/SparseCholesky>
#include <numbers>

#include "precompute/mesh/region.hpp"
#include "precompute/mesh/surface.hpp"
#include "precompute/mesh/tet_mesh.hpp"
#include "precompute/modal/elastic_modes.hpp"
#include "precompute/modal/elastic_statics.hpp"
#include "tests/precompute/discrete.hpp"
#include "tests/precompute/meshes.hpp"
#include "tests/support/catch.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::precompute;
using irdm::test::Discrete;

namespace {

const HalfSpace kLeftHalf{Vector3::Zero(), Vector3(3, 0, 0)};

}  // namespace

TEST_CASE("a half-space holds the nodes behind its plane, a box those within, bounds included") {
  const TetMesh mesh = test::box_mesh(Vector3(0.3, 0.2, 0.1), {3, 2, 1});
  for (const int node : nodes_in(mesh, kLeftHalf, "m")) CHECK(mesh.nodes(node, 0) == 0.0);
  CHECK(nodes_in(mesh, kLeftHalf, "m").size() == 3 * 2);
  CHECK(nodes_in(mesh, HalfSpace{Vector3(0.1, 0, 0), Vector3::UnitX()}, "m").size() == 2 * 3 * 2);
  CHECK(nodes_in(mesh, BoxRegion{Vector3(0.1, 0.1, 0), Vector3(0.3, 0.2, 0)}, "m").size() == 3 * 2);
  CHECK(nodes_in(mesh, BoxRegion{Vector3(5, 5, 5), Vector3(6, 6, 6)}, "m").empty());
}

TEST_CASE("supports that hold nothing, everything or not enough are refused") {
  const TetMesh mesh = test::box_mesh(Vector3(0.3, 0.2, 0.1), {3, 2, 1});
  const std::vector<int> surface = extract_surface(mesh, "m").nodes;
  const auto check = [&](const Vector3& lowest, const Vector3& highest) {
    check_clamped(mesh, nodes_in(mesh, BoxRegion{lowest, highest}, "m"), surface, "m");
  };
  CHECK_NOTHROW(check(Vector3(0, 0, 0), Vector3(0, 1, 1)));
  CHECK_THROWS_WITH(check(Vector3(5, 5, 5), Vector3(6, 6, 6)), ContainsSubstring("holds no node"));
  CHECK_THROWS_WITH(check(Vector3(0, 0, 0), Vector3(1, 1, 1)), ContainsSubstring("every node"));
  CHECK_THROWS_WITH(check(Vector3(0, 0, 0), Vector3(0, 0, 0)),
                    ContainsSubstring("1 node, about which"));
  CHECK_THROWS_WITH(check(Vector3(0, 0, 0), Vector3(0.1, 0, 0)),
                    ContainsSubstring("2 nodes on one line"));
  CHECK_THROWS_WITH(check(Vector3(0, 0, 0), Vector3(1, 0, 0)),
                    ContainsSubstring("4 nodes on one line"));
}

TEST_CASE("a slender beam clamped at one end bends at the frequency of beam theory") {
  // Thickness 1/40 of the length: shear and rotatory inertia lower the first mode by less than 0.1
  // %.
  const double length = 1.0;
  const double side = 0.025;
  const Material material{2e6, 0.0, 1000.0, 0.0, 0.0};
  const Discrete beam(quadratic_mesh(test::box_mesh(Vector3(length, side, side), {16, 1, 1})),
                      material);
  const ElasticModes modes =
      fixed_modes(beam.stiffness, beam.mass, nodes_in(beam.mesh, kLeftHalf, "beam"));
  const double stiffness = material.youngs_modulus * std::pow(side, 4) / 12.0;
  const double line_mass = material.density * side * side;
  const double expected = std::pow(1.8751041 / length, 2) * std::sqrt(stiffness / line_mass);
  CAPTURE(modes.angular_frequency(0), modes.angular_frequency(1), expected);
  CHECK(modes.angular_frequency(0) == Approx(expected).epsilon(0.01));
  CHECK(modes.angular_frequency(1) == Approx(expected).epsilon(0.01));  // the other direction
}

TEST_CASE("static limit of a fixed body's R is the answer of a sparse solve") {
  const Material material{2000.0, 0.49, 110.0, 8.0, 2e-4};
  const Discrete body(test::box_mesh(Vector3(0.12, 0.08, 0.10), {4, 3, 3}), material);
  const std::vector<int> clamped = nodes_in(body.mesh, kLeftHalf, "m");
  const ElasticModes modes = fixed_modes(body.stiffness, body.mass, clamped);
  REQUIRE(modes.angular_frequency.size() ==
          3 * (body.mesh.node_count() - static_cast<Eigen::Index>(clamped.size())));
  for (const int node : clamped) CHECK(modes.shapes.middleRows<3>(3 * node).isZero(0.0));

  SparseMatrix held = body.stiffness;
  const double stiff = 1e12 * Eigen::VectorXd(held.diagonal()).maxCoeff();
  for (const int node : clamped) {
    for (int axis = 0; axis < 3; ++axis) held.coeffRef(3 * node + axis, 3 * node + axis) += stiff;
  }
  Eigen::VectorXd force = Eigen::VectorXd::Zero(body.mass3.size());
  force(3 * test::node_at(body.mesh, Vector3(0.12, 0.08, 0.10)) + 2) = 1.0;
  const Eigen::VectorXd direct = Eigen::SimplicialLDLT<SparseMatrix>(held).solve(force);
  const Eigen::VectorXd modal = modes.shapes *
                                modes.angular_frequency.cwiseAbs2().cwiseInverse().asDiagonal() *
                                (modes.shapes.transpose() * force);
  CHECK((modal - direct).norm() < 1e-6 * direct.norm());
}

TEST_CASE("what is left of R is judged where the body moves") {
  const Material material{2000.0, 0.3, 110.0, 8.0, 2e-4};
  const Discrete body(test::box_mesh(Vector3(0.1, 0.1, 0.1), {2, 2, 2}), material);
  const ElasticModes modes =
      fixed_modes(body.stiffness, body.mass, nodes_in(body.mesh, kLeftHalf, "m"));
  const ModalResponse response =
      modal_response(modes, extract_surface(body.mesh, "m").nodes, material);
  const double left = decay_left(response, 0.002, 500);
  CHECK(left > 0.0);
  CHECK(left < 0.05);
}
