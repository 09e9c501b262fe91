#include <numbers>

#include "precompute/fem/mass_properties.hpp"
#include "precompute/mesh/make_mesh.hpp"
#include "precompute/mesh/mesh_check.hpp"
#include "precompute/mesh/round_mesh.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;
using namespace irdm::precompute;
using std::numbers::pi;

namespace {

constexpr double kBallRadius = 0.05;
constexpr double kRoundDensity = 800.0;
const CapsuleConfig kPeg{0.01, 0.1, 0};

MassProperties round_properties(const std::variant<SphereConfig, CapsuleConfig>& source,
                                int order) {
  MeshConfig config;
  std::visit([&](const auto& which) { config.source = which; }, source);
  config.order = order;
  const TetMesh mesh = make_mesh(config).mesh;
  CHECK(mesh.order() == order);
  for (int e = 0; e < mesh.tet_count(); ++e) CHECK(signed_volume(mesh, e) > 0.0);
  CHECK(report_mesh(mesh).worst_quality > 0.1);
  return solid_mass_properties(mesh, {.density = kRoundDensity});
}

// Of a cylinder along y with half spheres at its ends.
MassProperties capsule_closed_form(const CapsuleConfig& capsule) {
  const double r = capsule.radius;
  const double l = capsule.length;
  const double cylinder = kRoundDensity * pi * r * r * l;
  const double ball = kRoundDensity * 4.0 / 3.0 * pi * r * r * r;
  const double axial = 0.5 * cylinder * r * r + 0.4 * ball * r * r;
  const double across = cylinder * (r * r / 4.0 + l * l / 12.0) +
                        ball * (0.4 * r * r + l * l / 4.0 + 3.0 / 8.0 * l * r);
  return {cylinder + ball, Vector3::Zero(), Vector3(across, axial, across).asDiagonal()};
}

// Largest error of mass and moments of inertia, as a share.
double round_error(const MassProperties& found, const MassProperties& expected) {
  CHECK(found.centre_of_mass.norm() < 1e-12);
  CHECK((found.inertia - Matrix3(found.inertia.diagonal().asDiagonal())).norm() <
        1e-9 * found.inertia.norm());
  const Vector3 moments = found.inertia.diagonal().cwiseQuotient(expected.inertia.diagonal());
  return std::max(std::abs(found.mass / expected.mass - 1.0),
                  (moments - Vector3::Ones()).cwiseAbs().maxCoeff());
}

double error_of_sphere(int cells, int order) {
  const double mass = kRoundDensity * 4.0 / 3.0 * pi * std::pow(kBallRadius, 3);
  const Matrix3 inertia = 0.4 * mass * kBallRadius * kBallRadius * Matrix3::Identity();
  return round_error(round_properties(SphereConfig{kBallRadius, cells}, order),
                     {mass, Vector3::Zero(), inertia});
}

double error_of_capsule(int cells, int order) {
  CapsuleConfig peg = kPeg;
  peg.cells = cells;
  return round_error(round_properties(peg, order), capsule_closed_form(peg));
}

}  // namespace

TEST_CASE("the nodes of a sphere's surface lie on it, its triangles face outward") {
  for (const int cells : {1, 2, 5, 8}) {
    const SurfaceMesh ball = sphere_surface(cells);
    CHECK(ball.nodes.rows() == 6 * cells * cells + 2);
    CHECK(ball.triangles.rows() == 12 * cells * cells);
    CHECK((ball.nodes.rowwise().norm().array() - 1.0).abs().maxCoeff() < 1e-14);
    CHECK(enclosed_volume(checked_surface(ball, "ball")) > 0.0);
  }
}

TEST_CASE("the nodes of a capsule's surface are one radius away from its axis") {
  for (const int cells : {1, 2, 3, 4}) {
    for (const double length : {0.01, 1.0, 10.0}) {
      const SurfaceMesh capsule = capsule_surface(length, cells);
      CHECK_NOTHROW(checked_surface(capsule, "capsule"));
      for (Eigen::Index i = 0; i < capsule.nodes.rows(); ++i) {
        const Vector3 x = capsule.nodes.row(i).transpose();
        const Vector3 centre(0.0, std::clamp(x.y(), -0.5 * length, 0.5 * length), 0.0);
        CHECK((x - centre).norm() == Approx(1.0).epsilon(1e-12));
      }
      if (cells % 2 == 1) continue;  // no node at the poles
      CHECK(capsule.nodes.col(1).maxCoeff() == Approx(0.5 * length + 1.0));
    }
  }
}

TEST_CASE("mass and inertia of a sphere converge to the closed form with the cells squared") {
  const int order = GENERATE(1, 2);
  const double coarse = error_of_sphere(4, order);
  const double fine = error_of_sphere(8, order);
  CAPTURE(order, coarse, fine);
  CHECK(fine < 0.04);
  CHECK(coarse / fine > 3.5);
  CHECK(coarse / fine < 4.5);
}

TEST_CASE("mass and inertia of a capsule converge to the closed form with the cells squared",
          "[unsanitized]") {
  const int order = GENERATE(1, 2);
  const double coarse = error_of_capsule(4, order);
  const double fine = error_of_capsule(8, order);
  CAPTURE(order, coarse, fine);
  CHECK(fine < 0.04);
  CHECK(coarse / fine > 3.3);
  CHECK(coarse / fine < 4.7);
}

TEST_CASE("a round mesh of any size is the same mesh") {
  MeshConfig config;
  config.source = SphereConfig{1.0, 3};
  const TetMesh unit = make_mesh(config).mesh;
  config.source = SphereConfig{1e-6, 3};
  const TetMesh small = make_mesh(config).mesh;
  CHECK(small.tets == unit.tets);
  CHECK((1e6 * small.nodes - unit.nodes).norm() < 1e-9);
}
