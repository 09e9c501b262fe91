#include "precompute/fem/assembly.hpp"
#include "precompute/fem/mass_properties.hpp"
#include "tests/precompute/meshes.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;
using namespace irdm::precompute;

namespace {

Matrix3 box_inertia(double mass, const Vector3& s) {
  const Vector3 squares = s.cwiseAbs2();
  return (mass / 12.0 * (Vector3::Constant(squares.sum()) - squares)).asDiagonal();
}

}  // namespace

TEST_CASE("mass, centre of mass and inertia of a box are exact, wherever it stands") {
  const Vector3 size(0.12, 0.07, 0.05);
  const Vector3 offset(3.0, -2.0, 1.0);
  TetMesh mesh = test::box_mesh(size, {5, 3, 2});
  mesh.nodes.rowwise() += offset.transpose();
  const double density = 110.0;
  const double mass = density * size.prod();
  const MassProperties solid = solid_mass_properties(mesh, {.density = density});
  CHECK(solid.mass == Approx(mass).epsilon(1e-12));
  CHECK((solid.centre_of_mass - offset - 0.5 * size).norm() < 1e-12);
  const Matrix3 exact = box_inertia(mass, size);
  CHECK((solid.inertia - exact).norm() < 1e-12 * exact.norm());
}

TEST_CASE("lumped masses have the mass and centre of mass of the solid") {
  const TetMesh mesh = test::box_mesh(Vector3(0.12, 0.07, 0.05), {5, 3, 2});
  const MassProperties solid = solid_mass_properties(mesh, {.density = 110.0});
  const MassProperties nodal =
      nodal_mass_properties(mesh.nodes, lumped_mass(mesh, {.density = 110.0}));
  CHECK(nodal.mass == Approx(solid.mass).epsilon(1e-13));
  CHECK((nodal.centre_of_mass - solid.centre_of_mass).norm() < 1e-14);
}

TEST_CASE("inertia of the lumped masses nears the solid's with the square of the element size") {
  const auto excess = [](int cells) {
    const TetMesh mesh = test::box_mesh(Vector3(0.12, 0.12, 0.12), {cells, cells, cells});
    const Matrix3 solid = solid_mass_properties(mesh, {.density = 110.0}).inertia;
    const Matrix3 nodal =
        nodal_mass_properties(mesh.nodes, lumped_mass(mesh, {.density = 110.0})).inertia;
    return nodal.trace() / solid.trace() - 1.0;
  };
  const double coarse = excess(6);
  const double fine = excess(12);
  CHECK(coarse < 0.09);
  CHECK(fine < 0.03);
  CHECK(coarse / fine == Approx(4.0).margin(1.5));
}
