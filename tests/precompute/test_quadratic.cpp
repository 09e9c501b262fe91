#include <functional>
#include <numbers>
#include <random>

#include "precompute/fem/mass_properties.hpp"
#include "precompute/fem/tetrahedra.hpp"
#include "precompute/mesh/mesh_check.hpp"
#include "precompute/mesh/surface.hpp"
#include "precompute/mesh/tet_mesh.hpp"
#include "precompute/modal/elastic_modes.hpp"
#include "tests/precompute/discrete.hpp"
#include "tests/precompute/meshes.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;
using namespace irdm::precompute;
using irdm::test::Discrete;
using irdm::test::inertia_relief;
using irdm::test::lowest_frequency;
using irdm::test::node_at;

namespace {

const Material kMaterial{2000.0, 0.49, 110.0, 8.0, 2e-4};
const Vector3 kSize(0.12, 0.10, 0.11);

// A box of quadratic tetrahedra whose inner corners are shaken, so that nothing about it is
// regular.
TetMesh irregular_quadratic_mesh() {
  TetMesh mesh = test::box_mesh(kSize, {3, 3, 2});
  const Surface surface = extract_surface(mesh, "box");
  std::mt19937 random(1);
  std::uniform_real_distribution<double> shake(-0.0015, 0.0015);
  for (int i = static_cast<int>(surface.nodes.size()); i < mesh.node_count(); ++i) {
    for (int k = 0; k < 3; ++k) mesh.nodes(i, k) += shake(random);
  }
  return quadratic_mesh(mesh);
}

// A displacement u = G x + (x^T H_1 x, x^T H_2 x, x^T H_3 x).
struct QuadraticField {
  Matrix3 linear = Matrix3::Zero();
  std::array<Matrix3, 3> quadratic{Matrix3::Zero(), Matrix3::Zero(), Matrix3::Zero()};

  Vector3 at(const Vector3& x) const {
    Vector3 u = linear * x;
    for (int k = 0; k < 3; ++k) u(k) += x.dot(quadratic[static_cast<std::size_t>(k)] * x);
    return u;
  }
  Matrix3 gradient(const Vector3& x) const {
    Matrix3 g = linear;
    for (int k = 0; k < 3; ++k) {
      const Matrix3& h = quadratic[static_cast<std::size_t>(k)];
      g.row(k) += ((h + h.transpose()) * x).transpose();
    }
    return g;
  }
  Eigen::VectorXd nodal(const TetMesh& mesh) const {
    Eigen::VectorXd u(3 * mesh.node_count());
    for (int i = 0; i < mesh.node_count(); ++i) u.segment<3>(3 * i) = at(mesh.position(i));
    return u;
  }
};

Matrix3 some_matrix(int seed) {
  std::srand(static_cast<unsigned>(seed));
  return 0.01 * Matrix3::Random();
}

// Pure bending of the box about z with curvature 1: no stress but sigma_x = -E y, so that nothing
// has to act inside.
QuadraticField bending(double nu) {
  QuadraticField field;
  field.quadratic[0](0, 1) = -1.0;
  field.quadratic[1].diagonal() << 0.5, 0.5 * nu, -0.5 * nu;
  field.quadratic[2](1, 2) = nu;
  return field;
}

// Elastic energy in the box [0, kSize] by two Gauss points along each axis: exact for strains that
// are linear.
double exact_energy(const QuadraticField& field, const Lame& lame) {
  double energy = 0.0;
  const double g = 0.5 / std::sqrt(3.0);
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3 share(corner & 1 ? 0.5 + g : 0.5 - g, corner & 2 ? 0.5 + g : 0.5 - g,
                        corner & 4 ? 0.5 + g : 0.5 - g);
    const Matrix3 du_dx = field.gradient(share.cwiseProduct(kSize));
    energy += 0.5 * kSize.prod() / 8.0 * lame_stress(du_dx, lame).cwiseProduct(du_dx).sum();
  }
  return energy;
}

// Nodes that are not at the surface.
std::vector<int> inner_nodes(const TetMesh& mesh) {
  std::vector<bool> at_surface(static_cast<std::size_t>(mesh.node_count()), false);
  for (const int node : extract_surface(mesh, "box").nodes) {
    at_surface[static_cast<std::size_t>(node)] = true;
  }
  std::vector<int> inner;
  for (int i = 0; i < mesh.node_count(); ++i) {
    if (!at_surface[static_cast<std::size_t>(i)]) inner.push_back(i);
  }
  return inner;
}

double largest_inner_force(const TetMesh& mesh, const Eigen::VectorXd& force) {
  double largest = 0.0;
  for (const int node : inner_nodes(mesh)) {
    largest = std::max(largest, force.segment<3>(3 * node).cwiseAbs().maxCoeff());
  }
  return largest;
}

}  // namespace

TEST_CASE("quadratic mesh has one node in the middle of every edge and keeps the others") {
  const TetMesh linear = test::two_tets();
  const TetMesh mesh = quadratic_mesh(linear);
  CHECK(mesh.order() == 2);
  CHECK(mesh.node_count() == 5 + 9);
  CHECK(mesh.nodes.topRows(5) == linear.nodes);
  CHECK(mesh.tets.leftCols(4) == linear.tets);
  for (int e = 0; e < 2; ++e) {
    int node = 4;
    for (const auto& [i, j] : kTetEdges) {
      const Vector3 middle =
          0.5 * (mesh.position(mesh.tets(e, i)) + mesh.position(mesh.tets(e, j)));
      CHECK(mesh.position(mesh.tets(e, node++)) == middle);
    }
  }
  CHECK_NOTHROW(check_mesh(mesh, "m"));
}

TEST_CASE("a quadratic face is four triangles that cover it, outward") {
  const TetMesh linear = test::two_tets();
  const TetMesh mesh = quadratic_mesh(linear);
  const Surface coarse = extract_surface(linear, "m");
  const Surface fine = extract_surface(mesh, "m");
  CHECK(fine.nodes.size() == 5 + 9);
  REQUIRE(fine.triangles.rows() == 4 * coarse.triangles.rows());
  const auto area = [](const TetMesh& m, const Surface& s, Eigen::Index t) {
    const auto corner = [&](int i) {
      return m.position(s.nodes[static_cast<std::size_t>(s.triangles(t, i))]);
    };
    return Vector3(0.5 * (corner(1) - corner(0)).cross(corner(2) - corner(0)));
  };
  for (Eigen::Index t = 0; t < fine.triangles.rows(); ++t) {
    CHECK((4.0 * area(mesh, fine, t) - area(linear, coarse, t / 4)).norm() < 1e-15);
  }
}

TEST_CASE("the paper's cube of quadratic tetrahedra has the paper's surface") {
  const TetMesh mesh = quadratic_mesh(test::box_mesh(Vector3(0.12, 0.12, 0.12), {6, 6, 6}));
  const Surface surface = extract_surface(mesh, "cube");
  CHECK(surface.nodes.size() == 866);
  CHECK(surface.triangles.rows() == 1728);
}

TEST_CASE("patch test: a linear displacement gives Hooke's stress and no forces inside") {
  const TetMesh mesh = irregular_quadratic_mesh();
  const Lame lame = lame_parameters(kMaterial);
  QuadraticField field;
  field.linear = some_matrix(1);
  const Eigen::VectorXd u = field.nodal(mesh);
  const Eigen::VectorXd force = assemble_stiffness(mesh, kMaterial) * u;
  REQUIRE(inner_nodes(mesh).size() > 50);
  CHECK(largest_inner_force(mesh, force) < 1e-12 * force.cwiseAbs().maxCoeff());
  const Matrix3 expected = lame_stress(field.linear, lame);
  for (int e = 0; e < mesh.tet_count(); ++e) {
    tet4::Corners corners;
    tet10::Displacements element;
    for (int i = 0; i < 10; ++i) element.row(i) = u.segment<3>(3 * mesh.tets(e, i)).transpose();
    for (int i = 0; i < 4; ++i) corners.row(i) = mesh.nodes.row(mesh.tets(e, i));
    for (const tet10::Barycentric& b :
         {tet10::Barycentric(0.25, 0.25, 0.25, 0.25), tet10::Barycentric(0.7, 0.0, 0.2, 0.1)}) {
      const Matrix3 stress = tet10::stress(tet4::geometry(corners), b, lame, element);
      REQUIRE((stress - expected).norm() < 1e-10 * expected.norm());
    }
  }
}

TEST_CASE("any quadratic displacement is reproduced with its exact elastic energy") {
  const TetMesh mesh = irregular_quadratic_mesh();
  const Lame lame = lame_parameters(kMaterial);
  const SparseMatrix stiffness = assemble_stiffness(mesh, kMaterial);
  for (int seed = 1; seed <= 3; ++seed) {
    const QuadraticField field{some_matrix(seed),
                               {some_matrix(seed + 10), some_matrix(seed + 20), some_matrix(seed)}};
    const Eigen::VectorXd u = field.nodal(mesh);
    CHECK(0.5 * u.dot(stiffness * u) == Approx(exact_energy(field, lame)).epsilon(1e-11));
  }
}

TEST_CASE("pure bending is exact: energy E I / 2 per length, no forces inside") {
  const TetMesh mesh = irregular_quadratic_mesh();
  const SparseMatrix stiffness = assemble_stiffness(mesh, kMaterial);
  const Eigen::VectorXd u = bending(kMaterial.poisson_ratio).nodal(mesh);
  const Eigen::VectorXd force = stiffness * u;
  CHECK(largest_inner_force(mesh, force) < 1e-11 * force.cwiseAbs().maxCoeff());
  const double second_moment = kSize.z() * std::pow(kSize.y(), 3) / 3.0;  // about y = 0
  CHECK(0.5 * u.dot(force) ==
        Approx(0.5 * kMaterial.youngs_modulus * second_moment * kSize.x()).epsilon(1e-11));
}

TEST_CASE(
    "lumped masses of quadratic tetrahedra are positive, mass and centre those of the solid") {
  const TetMesh mesh = irregular_quadratic_mesh();
  const Eigen::VectorXd mass = lumped_mass(mesh, {.density = 110.0});
  CHECK(mass.minCoeff() > 0.0);
  const MassProperties solid = solid_mass_properties(mesh, {.density = 110.0});
  const MassProperties nodal = nodal_mass_properties(mesh.nodes, mass);
  CHECK(solid.mass == Approx(110.0 * kSize.prod()).epsilon(1e-13));
  CHECK(nodal.mass == Approx(solid.mass).epsilon(1e-13));
  CHECK((nodal.centre_of_mass - 0.5 * kSize).norm() < 1e-14);
  CHECK(nodal.inertia.trace() / solid.inertia.trace() < 1.12);
}

TEST_CASE("a free body of quadratic tetrahedra has six rigid modes and no more") {
  const Discrete body(quadratic_mesh(test::box_mesh(Vector3(0.12, 0.08, 0.10), {2, 2, 2})),
                      kMaterial);
  const double scale = Eigen::VectorXd(body.stiffness.diagonal()).maxCoeff() * body.rigid.norm();
  CHECK((body.stiffness * body.rigid).norm() < 1e-13 * scale);
  // Throws unless there are exactly six.
  const ElasticModes modes = elastic_modes(body.stiffness, body.mesh.nodes, body.mass);
  CHECK(modes.angular_frequency.size() == 3 * body.mesh.node_count() - 6);
}

TEST_CASE("static uniaxial stretch is exact") {
  const Vector3 size(0.2, 0.1, 0.1);
  const Discrete body(quadratic_mesh(test::box_mesh(size, {4, 2, 2})), kMaterial);
  const Surface surface = extract_surface(body.mesh, "box");
  const double stress = 10.0;
  // A constant traction acts on the mid-side nodes of a quadratic face alone, a third of its area
  // each; they are the corners of the last of its four triangles.
  Eigen::VectorXd force = Eigen::VectorXd::Zero(body.mass3.size());
  for (Eigen::Index t = 3; t < surface.triangles.rows(); t += 4) {
    const auto node = [&](int i) {
      return surface.nodes[static_cast<std::size_t>(surface.triangles(t, i))];
    };
    const Vector3 a = body.mesh.position(node(0));
    const Vector3 area =
        2.0 * (body.mesh.position(node(1)) - a).cross(body.mesh.position(node(2)) - a);
    for (int i = 0; i < 3; ++i) force(3 * node(i)) += stress * area.x() / 3.0;
  }
  const Eigen::VectorXd found = inertia_relief(body, force, node_at(body.mesh, Vector3::Zero()),
                                               node_at(body.mesh, Vector3(size.x(), 0, 0)),
                                               node_at(body.mesh, Vector3(0, size.y(), 0)));
  QuadraticField stretch;
  const double strain = stress / kMaterial.youngs_modulus;
  stretch.linear.diagonal() << strain, -kMaterial.poisson_ratio * strain,
      -kMaterial.poisson_ratio * strain;
  const Eigen::VectorXd expected = body.without_rigid(stretch.nodal(body.mesh));
  CHECK((found - expected).norm() < 1e-8 * expected.norm());
}

TEST_CASE("a slender free beam bends at the frequency of beam theory") {
  // Thickness 1/40 of the length: shear and rotatory inertia, which Euler and Bernoulli leave out,
  // lower the first mode by 0.5 (4.73 r / L)^2 (1 + E / (5/6 G)) = 0.2 % (r the radius of
  // gyration).
  const double length = 1.0;
  const double side = 0.025;
  const Material material{2e6, 0.0, 1000.0, 0.0, 0.0};
  const Discrete beam(quadratic_mesh(test::box_mesh(Vector3(length, side, side), {24, 1, 1})),
                      material);
  const double stiffness = material.youngs_modulus * std::pow(side, 4) / 12.0;
  const double line_mass = material.density * side * side;
  const double expected =
      std::pow(4.7300407 / length, 2) * std::sqrt(stiffness / line_mass) / (2.0 * std::numbers::pi);
  const double found = lowest_frequency(beam, 1.0);
  CAPTURE(found, expected);
  CHECK(found == Approx(expected).epsilon(0.01));
}

TEST_CASE("lowest elastic frequency of the paper's cube is within 1 % of 9.37 Hz", "[slow]") {
  const Discrete body(quadratic_mesh(test::box_mesh(Vector3(0.12, 0.12, 0.12), {6, 6, 6})),
                      kMaterial);
  const double found = lowest_frequency(body, 1000.0);
  CAPTURE(found);
  CHECK(found == Approx(9.37).epsilon(0.01));
}
