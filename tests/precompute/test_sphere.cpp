#include <cmath>
#include <fstream>
#include <numbers>

#include "precompute/fem/mass_properties.hpp"
#include "precompute/mesh/mesh_file.hpp"
#include "precompute/mesh/tet_mesh.hpp"
#include "precompute/modal/lowest_modes.hpp"
#include "tests/precompute/discrete.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace irdm;
using namespace irdm::precompute;
using irdm::test::Discrete;

namespace {

double j(unsigned n, double x) {
  return std::sph_bessel(n, x);
}

// Spheroidal modes of degree 2 of a free sphere (Lamb 1882; Eringen and Suhubi, Elastodynamics II,
// section 8.14): zero where eta = omega a / c_s belongs to one.
double spheroidal(double eta, double poisson_ratio) {
  const double n = 2.0;
  const double xi = eta * std::sqrt((1 - 2 * poisson_ratio) / (2 - 2 * poisson_ratio));
  const double half = 0.5 * eta * eta;
  const double t11 = (n * n - n - half) * j(2, xi) + 2 * xi * j(3, xi);
  const double t13 = n * (n + 1) * ((n - 1) * j(2, eta) - eta * j(3, eta));
  const double t41 = (n - 1) * j(2, xi) - xi * j(3, xi);
  const double t43 = (n * n - 1 - half) * j(2, eta) + eta * j(3, eta);
  return t11 * t43 - t13 * t41;
}

double lowest_spheroidal(double poisson_ratio) {
  double low = 1.0;
  double high = low;
  while (spheroidal(low, poisson_ratio) * spheroidal(high, poisson_ratio) > 0) high += 0.01;
  low = high - 0.01;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    const bool left = spheroidal(low, poisson_ratio) * spheroidal(middle, poisson_ratio) <= 0;
    (left ? high : low) = middle;
  }
  return low;
}

TetMesh ball(double radius, double edge_length) {
  const irdm::test::TemporaryFolder folder;
  const auto path = folder.path() / "ball.geo";
  std::ofstream(path) << "SetFactory(\"OpenCASCADE\");\nSphere(1) = {0, 0, 0, " << radius
                      << "};\nMesh.CharacteristicLengthMax = " << edge_length << ";\n";
  return read_mesh_file(path);
}

}  // namespace

TEST_CASE("Lamb's equation has the tabulated root") {
  CHECK(lowest_spheroidal(0.25) == Approx(2.640).epsilon(1e-3));
}

TEST_CASE("the lowest spheroidal modes of a free sphere are Lamb's within 2 %", "[slow]") {
  for (const double poisson_ratio : {0.3, 0.45}) {
    const Material material{3000.0, poisson_ratio, 1000.0, 0.0, 0.0};
    const Discrete body(quadratic_mesh(ball(0.05, 0.018)), material);
    const ElasticStatics statics(body.stiffness, body.mesh.nodes, body.mass, {});
    const ElasticModes modes = lowest_modes(statics, 20);
    // The facets cut a little off the sphere: its radius is that of the same volume.
    const double volume = body.mass.sum() / material.density;
    const double radius = std::cbrt(3.0 * volume / (4.0 * std::numbers::pi));
    const double shear_speed =
        std::sqrt(material.youngs_modulus / (2.0 * (1.0 + poisson_ratio)) / material.density);
    const double expected = lowest_spheroidal(poisson_ratio) * shear_speed / radius;
    // Torsional modes, which come first, move nothing along the radius.
    int found = 0;
    for (Eigen::Index m = 0; found < 5; ++m) {
      REQUIRE(m < 20);
      double along = 0.0;
      for (int i = 0; i < body.mesh.node_count(); ++i) {
        const Vector3 x = body.mesh.position(i);
        if (x.norm() < 1e-6) continue;
        const double radial = modes.shapes.col(m).segment<3>(3 * i).dot(x.normalized());
        along += body.mass(i) * radial * radial;
      }
      if (along < 0.1) continue;
      ++found;
      INFO("nu " << poisson_ratio << ", mode " << m << ", " << body.mesh.node_count() << " nodes");
      CHECK(modes.angular_frequency(m) == Approx(expected).epsilon(0.02));
    }
  }
}
