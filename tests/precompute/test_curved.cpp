#include <numbers>
#include <random>

#include "precompute/fem/mass_properties.hpp"
#include "precompute/fem/tetrahedra.hpp"
#include "precompute/mesh/make_mesh.hpp"
#include "precompute/mesh/mesh_check.hpp"
#include "precompute/mesh/mesh_file.hpp"
#include "precompute/mesh/region.hpp"
#include "precompute/mesh/surface.hpp"
#include "precompute/modal/lowest_modes.hpp"
#include "tests/precompute/discrete.hpp"
#include "tests/precompute/mesh_files.hpp"
#include "tests/precompute/meshes.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;
using namespace irdm::precompute;
using irdm::test::Discrete;

namespace {

const Material kCurvedMaterial{3000.0, 0.4, 1000.0, 0.0, 0.0};
const Vector3 kCurvedSize(0.12, 0.10, 0.11);
constexpr double kRadius = 0.05;

// A box whose surface is flat and all of whose inner edges are curved.
TetMesh curved_box() {
  TetMesh mesh = quadratic_mesh(test::box_mesh(kCurvedSize, {3, 3, 2}));
  std::vector<bool> moves(static_cast<std::size_t>(mesh.node_count()), true);
  for (const int node : extract_surface(mesh, "box").nodes) {
    moves[static_cast<std::size_t>(node)] = false;
  }
  std::mt19937 random(1);
  std::uniform_real_distribution<double> shake(-0.0008, 0.0008);
  for (int i = 0; i < mesh.node_count(); ++i) {
    if (!moves[static_cast<std::size_t>(i)]) continue;
    for (int k = 0; k < 3; ++k) mesh.nodes(i, k) += shake(random);
  }
  return mesh;
}

// By the program gmsh, which puts mid-side nodes on the surface.
TetMesh curved_ball(const test::MeshFiles& files, double edge_length) {
  return make_mesh({.source = files.write("ball.geo",
                                          "SetFactory(\"OpenCASCADE\");\n"
                                          "Sphere(1) = {0, 0, 0, 0.05};\n"
                                          "Mesh.CharacteristicLengthMax = " +
                                              std::to_string(edge_length) +
                                              ";\nMesh.ElementOrder = 2;\n"),
                    .edge_length = std::nullopt,
                    .order = 2})
      .mesh;
}

Eigen::VectorXd field(const TetMesh& mesh, const Matrix3& gradient) {
  return (mesh.nodes * gradient.transpose()).reshaped<Eigen::RowMajor>();
}

}  // namespace

TEST_CASE("curved elements strain evenly under a linear displacement and not at all as they turn") {
  const TetMesh mesh = curved_box();
  CHECK_NOTHROW(check_mesh(mesh, "m"));
  const SparseMatrix stiffness = assemble_stiffness(mesh, kCurvedMaterial);
  Matrix3 turn;
  turn << 0, -3, 2, 3, 0, -1, -2, 1, 0;
  const Eigen::VectorXd turned = field(mesh, turn);
  CHECK((stiffness * turned).norm() < 1e-12 * stiffness.norm() * turned.norm());

  Matrix3 gradient;
  gradient << 0.1, 0.4, -0.2, 0.3, -0.2, 0.1, 0.5, 0.2, 0.3;
  const Eigen::VectorXd u = field(mesh, gradient);
  double volume = 0.0;
  for (int e = 0; e < mesh.tet_count(); ++e) {
    volume += element_volume(mesh, e);
    tet10::Displacements element;
    for (int i = 0; i < 10; ++i) element.row(i) = u.segment<3>(3 * mesh.tets(e, i)).transpose();
    const tet10::Barycentric b(0.6, 0.1, 0.1, 0.2);
    const tet4::Geometry near = tet10::geometry(mesh, e, b);
    REQUIRE((element.transpose() * tet10::gradients(near, b) - gradient).norm() < 1e-12);
  }
  const Matrix3 stress = lame_stress(gradient, lame_parameters(kCurvedMaterial));
  const double density = 0.5 * stress.cwiseProduct(gradient).sum();
  CHECK(0.5 * u.dot(stiffness * u) == Approx(density * volume).epsilon(1e-12));
  // Four points do not integrate the cubic Jacobian exactly.
  CHECK(volume == Approx(kCurvedSize.prod()).epsilon(1e-3));
}

TEST_CASE("mass and inertia of a body with curved elements inside are those of the body") {
  const TetMesh mesh = curved_box();
  const MassProperties curved = solid_mass_properties(mesh, kCurvedMaterial);
  const MassProperties straight =
      solid_mass_properties(test::box_mesh(kCurvedSize, {3, 3, 2}), kCurvedMaterial);
  CHECK(curved.mass == Approx(straight.mass).epsilon(1e-12));
  CHECK((curved.centre_of_mass - straight.centre_of_mass).norm() < 1e-13);
  CHECK((curved.inertia - straight.inertia).norm() < 1e-12 * straight.inertia.norm());
}

TEST_CASE("a geometry script of second order gives a ball its own surface") {
  const test::MeshFiles files;
  const TetMesh mesh = curved_ball(files, 0.018);
  REQUIRE(mesh.order() == 2);
  for (const int node : extract_surface(mesh, "ball").nodes) {
    REQUIRE(mesh.position(node).norm() == Approx(kRadius).epsilon(1e-6));
  }
  const double volume = 4.0 / 3.0 * std::numbers::pi * std::pow(kRadius, 3);
  const MassProperties solid = solid_mass_properties(mesh, kCurvedMaterial);
  CHECK(solid.mass == Approx(kCurvedMaterial.density * volume).epsilon(2e-3));
  CHECK(solid.inertia.trace() == Approx(1.2 * solid.mass * kRadius * kRadius).epsilon(2e-3));
  const MassProperties nodal =
      nodal_mass_properties(mesh.nodes, lumped_mass(mesh, kCurvedMaterial));
  CHECK(nodal.mass == Approx(solid.mass).epsilon(1e-3));
  CHECK((nodal.centre_of_mass - solid.centre_of_mass).norm() < 1e-3 * kRadius);
}

TEST_CASE("the lowest torsional modes of a ball with curved elements are Lamb's within 2 %",
          "[slow]") {
  const test::MeshFiles files;
  const Discrete body(curved_ball(files, 0.018), kCurvedMaterial);
  const ElasticStatics statics(body.stiffness, body.mesh.nodes, body.mass, {});
  const ElasticModes modes = lowest_modes(statics, 5);
  // Degree 2: j_2(eta) = eta j_3(eta), with eta = omega a / c_s.
  const double shear =
      kCurvedMaterial.youngs_modulus / (2.0 * (1.0 + kCurvedMaterial.poisson_ratio));
  const double expected = 2.5011 * std::sqrt(shear / kCurvedMaterial.density) / kRadius;
  for (Eigen::Index m = 0; m < 5; ++m) {
    CHECK(modes.angular_frequency(m) == Approx(expected).epsilon(0.02));
  }
}

TEST_CASE("second-order Gmsh files keep their mid-side nodes, in the order of kTetEdges") {
  const test::MeshFiles files;
  files.write("block.geo",
              "SetFactory(\"OpenCASCADE\");\nBox(1) = {0, 0, 0, 1, 1, 1};\n"
              "Mesh.MeshSizeMax = 0.5;\nPhysical Surface(\"side\") = {1};\n"
              "Physical Volume(7) = {1};\n");
  for (const std::string format : {"msh22", "msh41"}) {
    files.run("gmsh -3 block.geo -o block.msh -order 2 -format " + format);
    const TetMesh mesh = read_mesh_file(files.path() / "block.msh");
    CHECK_NOTHROW(check_mesh(mesh, "m"));
    for (int e = 0; e < mesh.tet_count(); ++e) REQUIRE(is_straight(mesh, e));
    const HalfSpace side{.point = Vector3::Zero(), .normal = Vector3::UnitX()};
    CHECK(nodes_in(mesh, GroupRegion{"side"}, "m") == nodes_in(mesh, side, "m"));
    CHECK(elements_in(mesh, GroupRegion{"7"}, "m").size() ==
          static_cast<std::size_t>(mesh.tet_count()));
    CHECK_THROWS_WITH(
        make_mesh({.source = files.path() / "block.msh", .edge_length = std::nullopt, .order = 1}),
        Catch::Matchers::ContainsSubstring("second-order"));
  }
}

TEST_CASE("an element that is curved until it folds over is refused") {
  TetMesh mesh = quadratic_mesh(test::two_tets());
  mesh.nodes.row(mesh.tets(0, 4)) +=
      0.6 * (mesh.nodes.row(mesh.tets(0, 1)) - mesh.nodes.row(mesh.tets(0, 0)));
  CHECK_THROWS_WITH(check_mesh(mesh, "m"), Catch::Matchers::ContainsSubstring("folds over"));
}
