#include <random>

#include "precompute/fem/assembly.hpp"
#include "precompute/fem/rigid_motions.hpp"
#include "precompute/fem/tetrahedra.hpp"
#include "precompute/mesh/surface.hpp"
#include "tests/precompute/meshes.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;
using namespace irdm::precompute;

namespace {

const Material kPatchMaterial{2000.0, 0.49, 110.0, 8.0, 2e-4};

// The box's mesh with its inner nodes shaken, so that nothing about it is regular.
TetMesh irregular_mesh() {
  TetMesh mesh = test::box_mesh(Vector3(0.12, 0.10, 0.11), {5, 4, 5});
  const Surface surface = extract_surface(mesh, "box");
  std::mt19937 random(1);
  std::uniform_real_distribution<double> shake(-0.0015, 0.0015);
  for (int i = static_cast<int>(surface.nodes.size()); i < mesh.node_count(); ++i) {
    for (int k = 0; k < 3; ++k) mesh.nodes(i, k) += shake(random);
  }
  return mesh;
}

Matrix3 some_gradient() {
  Matrix3 g;
  g << 0.01, -0.02, 0.005, 0.03, 0.02, -0.01, 0.004, 0.007, -0.015;
  return g;
}

Eigen::VectorXd linear_field(const TetMesh& mesh, const Matrix3& gradient) {
  const Points u = mesh.nodes * gradient.transpose();
  return Eigen::Map<const Eigen::VectorXd>(u.data(), u.size());
}

}  // namespace

TEST_CASE("patch test: a linear displacement needs no forces inside an irregular mesh") {
  const TetMesh mesh = irregular_mesh();
  const SparseMatrix stiffness = assemble_stiffness(mesh, kPatchMaterial);
  const Eigen::VectorXd force = stiffness * linear_field(mesh, some_gradient());
  const auto n = static_cast<Eigen::Index>(extract_surface(mesh, "box").nodes.size());
  REQUIRE(mesh.node_count() >= n + 10);
  const double inside = force.tail(force.size() - 3 * n).cwiseAbs().maxCoeff();
  CHECK(inside < 1e-12 * force.cwiseAbs().maxCoeff());
}

TEST_CASE("patch test: a linear displacement gives Hooke's stress in every element") {
  const TetMesh mesh = irregular_mesh();
  const Matrix3 gradient = some_gradient();
  const Matrix3 strain = 0.5 * (gradient + gradient.transpose());
  const double e = kPatchMaterial.youngs_modulus;
  const double nu = kPatchMaterial.poisson_ratio;
  const Matrix3 expected =
      e / (1 + nu) * (strain + nu / (1 - 2 * nu) * strain.trace() * Matrix3::Identity());
  for (int t = 0; t < mesh.tet_count(); ++t) {
    tet4::Corners corners;
    for (int i = 0; i < 4; ++i) corners.row(i) = mesh.nodes.row(mesh.tets(t, i));
    const tet4::Displacements u = corners * gradient.transpose();
    const Matrix3 stress =
        tet4::stress(tet4::geometry(corners), lame_parameters(kPatchMaterial), u);
    REQUIRE((stress - expected).norm() < 1e-10 * expected.norm());
  }
}

TEST_CASE("element forces are the stress times the faces, element stiffness is symmetric") {
  tet4::Corners corners;
  corners << 0.1, 0.2, 0.0, 1.3, 0.1, -0.1, 0.2, 0.9, 0.3, 0.0, 0.1, 1.1;
  const tet4::Geometry geometry = tet4::geometry(corners);
  const Lame lame = lame_parameters(kPatchMaterial);
  const tet4::Stiffness k = tet4::stiffness(geometry, lame);
  CHECK((k - k.transpose()).norm() < 1e-12 * k.norm());
  const tet4::Displacements u = corners * some_gradient().transpose();
  const Eigen::Matrix<double, 12, 1> force =
      k * Eigen::Map<const Eigen::Matrix<double, 12, 1>>(
              Eigen::Matrix<double, 4, 3, Eigen::RowMajor>(u).data());
  // Corner 3 takes the traction of the opposite face (0, 1, 2) by a third with the sign turned, and
  // V grad(b_3) = -area normal / 3.
  const Vector3 a = corners.row(0).transpose();
  const Vector3 b = corners.row(1).transpose();
  const Vector3 c = corners.row(2).transpose();
  const Vector3 area = 0.5 * (b - a).cross(c - a);  // towards corner 3
  const Vector3 expected = tet4::stress(geometry, lame, u) * area / 3.0;
  CHECK((force.tail<3>() - expected).norm() < 1e-12 * expected.norm());
}

TEST_CASE("rigid motions cost no elastic energy and are mass-normalised") {
  const TetMesh mesh = irregular_mesh();
  const SparseMatrix stiffness = assemble_stiffness(mesh, kPatchMaterial);
  const Eigen::VectorXd mass = lumped_mass(mesh, kPatchMaterial);
  const Eigen::MatrixXd motions = rigid_motions(mesh.nodes, mass);
  const double scale = Eigen::VectorXd(stiffness.diagonal()).maxCoeff() * motions.norm();
  CHECK((stiffness * motions).norm() < 1e-13 * scale);
  const Eigen::VectorXd mass3 = mass.replicate(1, 3).transpose().reshaped();
  const Eigen::MatrixXd gram = motions.transpose() * mass3.asDiagonal() * motions;
  CHECK((gram - Eigen::MatrixXd::Identity(6, 6)).norm() < 1e-12);
}
