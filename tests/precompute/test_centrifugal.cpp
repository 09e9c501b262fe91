#include "precompute/fem/assembly.hpp"
#include "precompute/fem/mass_properties.hpp"
#include "precompute/modal/elastic_modes.hpp"
#include "tests/precompute/discrete.hpp"
#include "tests/precompute/meshes.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;
using namespace irdm::precompute;
using irdm::test::Discrete;

namespace {

// A box about its centre of mass, its masses not symmetric.
struct Centred {
  Discrete body{test::box_mesh(Vector3(0.12, 0.08, 0.10), {4, 3, 3}),
                {2000.0, 0.49, 110.0, 8.0, 2e-4}};
  Points nodes = body.mesh.nodes.rowwise() -
                 nodal_mass_properties(body.mesh.nodes, body.mass).centre_of_mass.transpose();

  // m_i a(X_i) on every node.
  template <typename Acceleration>
  Eigen::VectorXd load(const Acceleration& acceleration) const {
    Eigen::VectorXd f(3 * nodes.rows());
    for (Eigen::Index i = 0; i < nodes.rows(); ++i) {
      f.segment<3>(3 * i) = body.mass(i) * acceleration(Vector3(nodes.row(i).transpose()));
    }
    return f;
  }
  // What an elastic mode takes of a load, as a share of the most that it could: Phi^T f is part of
  // M^-1/2 f in orthonormal coordinates.
  double share(const ElasticModes& modes, const Eigen::VectorXd& f) const {
    return (modes.shapes.transpose() * f).norm() /
           body.mass3.cwiseSqrt().cwiseInverse().cwiseProduct(f).norm();
  }
};

}  // namespace

TEST_CASE("the six loads add up to the centrifugal force of any spin") {
  const Centred box;
  const auto loads = centrifugal_loads(box.nodes, box.body.mass);
  for (const Vector3& w : {Vector3(3, 0, 0), Vector3(0, -2, 0), Vector3(1, 2, -3)}) {
    const Eigen::VectorXd direct =
        box.load([&](const Vector3& X) -> Vector3 { return -w.cross(w.cross(X)); });
    CHECK((loads * spin_products(w) - direct).norm() < 1e-14 * direct.norm());
  }
  Vector3 sum = Vector3::Zero();
  const Eigen::VectorXd load = loads * spin_products(Vector3(1, 2, -3));
  for (Eigen::Index i = 0; i < box.nodes.rows(); ++i) sum += load.segment<3>(3 * i);
  CHECK(sum.norm() < 1e-12 * load.lpNorm<1>());
}

TEST_CASE("neither angular nor uniform acceleration moves an elastic mode, but a spin does") {
  const Centred box;
  const ElasticModes modes = elastic_modes(box.body.stiffness, box.nodes, box.body.mass);
  for (const Vector3& a : {Vector3(1, 0, 0), Vector3(0, 1, 0), Vector3(0.3, -2, 1)}) {
    const Eigen::VectorXd euler =
        box.load([&](const Vector3& X) -> Vector3 { return -a.cross(X); });
    const Eigen::VectorXd uniform = box.load([&](const Vector3&) -> Vector3 { return -a; });
    const Eigen::VectorXd centrifugal =
        box.load([&](const Vector3& X) -> Vector3 { return -a.cross(a.cross(X)); });
    CHECK(box.share(modes, euler) < 1e-10);
    CHECK(box.share(modes, uniform) < 1e-10);
    CHECK(box.share(modes, centrifugal) > 0.1);
  }
}
