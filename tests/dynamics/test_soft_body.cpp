#include "precompute/dynamics/soft_body.hpp"
#include "precompute/fem/assembly.hpp"
#include "precompute/mesh/material_regions.hpp"
#include "precompute/mesh/tet_mesh.hpp"
#include "tests/precompute/meshes.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;
using namespace irdm::precompute;

namespace {

SoftBody body(int order, Elasticity elasticity, double alpha, double beta) {
  const TetMesh linear = test::box_mesh(Vector3(0.12, 0.08, 0.10), {3, 2, 2});
  return {
      order == 1 ? linear : quadratic_mesh(linear), {2000.0, 0.3, 110.0, alpha, beta}, elasticity};
}

// Turned by 2 rad, stretched at random and in motion.
BodyState some_state(const SoftBody& b) {
  std::srand(1);
  const Matrix3 Q = Eigen::AngleAxisd(2.0, Vector3(1, 2, -3).normalized()).matrix();
  const Points u =
      (b.rest() + 0.004 * Points::Random(b.node_count(), 3)) * Q.transpose() - b.rest();
  const Points v = Points::Random(b.node_count(), 3);
  return {u.reshaped<Eigen::RowMajor>(), v.reshaped<Eigen::RowMajor>()};
}

Vector3 torque(const SoftBody& b, const BodyState& state, const Eigen::VectorXd& force) {
  Vector3 sum = Vector3::Zero();
  for (int i = 0; i < b.node_count(); ++i) {
    const Vector3 x = b.rest().row(i).transpose() + state.u.segment<3>(3 * i);
    sum += x.cross(force.segment<3>(3 * i));
  }
  return sum;
}

Vector3 resultant(const Eigen::VectorXd& force) {
  return force.reshaped(3, force.size() / 3).rowwise().sum();
}

}  // namespace

TEST_CASE("linear forces are those of the assembled stiffness") {
  const int order = GENERATE(1, 2);
  const SoftBody b = body(order, Elasticity::kLinear, 0.0, 0.1);
  const BodyState state = some_state(b);
  const SparseMatrix k = b.stiffness(state.u);
  const TetMesh linear = test::box_mesh(Vector3(0.12, 0.08, 0.10), {3, 2, 2});
  const SparseMatrix assembled =
      assemble_stiffness(order == 1 ? linear : quadratic_mesh(linear), {2000.0, 0.3, 110.0, 0, 0});
  CHECK((k - assembled).norm() < 1e-12 * assembled.norm());
  const Eigen::VectorXd expected = -(k * (state.u + 0.1 * state.v));
  CHECK((b.internal_force(state) - expected).norm() < 1e-12 * expected.norm());
}

TEST_CASE("at rest a body of two materials has the assembled stiffness of both") {
  const auto elasticity =
      GENERATE(Elasticity::kLinear, Elasticity::kCorotational, Elasticity::kNeoHookean);
  TetMesh mesh = test::box_mesh(Vector3(0.12, 0.08, 0.10), {3, 2, 2});
  if (GENERATE(false, true)) mesh = quadratic_mesh(mesh);
  Material material{2000.0, 0.3, 110.0, 0, 0};
  material.elements =
      element_materials(mesh, material,
                        {{Region(HalfSpace{Vector3(0.06, 0, 0), Vector3::UnitX()}),
                          {.youngs_modulus = 50000.0, .poisson_ratio = 0.1, .density = 300.0}}},
                        false, "box");
  const SoftBody b(mesh, material, elasticity);
  const SparseMatrix assembled = assemble_stiffness(mesh, material);
  const Material uniform{2000.0, 0.3, 110.0, 0, 0};
  CHECK((assembled - assemble_stiffness(mesh, uniform)).norm() > 0.5 * assembled.norm());
  CHECK((b.stiffness(b.at_rest().u) - assembled).norm() < 1e-12 * assembled.norm());
  CHECK(b.mass() == lumped_mass(mesh, material));
  // The energy and the force of a large displacement are each other's, too.
  BodyState state = some_state(b);
  const Eigen::VectorXd force = b.internal_force(state);
  const double step = 1e-7;
  for (const Eigen::Index dof : {0, 20, 41}) {
    Eigen::VectorXd more = state.u;
    Eigen::VectorXd less = state.u;
    more(dof) += step;
    less(dof) -= step;
    const double slope = (b.elastic_energy(more) - b.elastic_energy(less)) / (2.0 * step);
    CHECK(force(dof) == Approx(-slope).epsilon(1e-5).margin(1e-6 * force.norm()));
  }
}

TEST_CASE("elastic force of large strains is the gradient of the energy") {
  const int order = GENERATE(1, 2);
  const auto elasticity = GENERATE(Elasticity::kCorotational, Elasticity::kNeoHookean);
  const SoftBody b = body(order, elasticity, 0.0, 0.0);
  BodyState state = some_state(b);
  const Eigen::VectorXd force = b.internal_force(state);
  const double step = 1e-7;
  for (const Eigen::Index dof : {0, 7, 20, 41}) {
    Eigen::VectorXd more = state.u;
    Eigen::VectorXd less = state.u;
    more(dof) += step;
    less(dof) -= step;
    const double slope = (b.elastic_energy(more) - b.elastic_energy(less)) / (2.0 * step);
    CHECK(force(dof) == Approx(-slope).epsilon(1e-6).margin(1e-7 * force.norm()));
  }
}

TEST_CASE("forces of large strains have neither resultant nor torque, damping included") {
  const int order = GENERATE(1, 2);
  const auto elasticity = GENERATE(Elasticity::kCorotational, Elasticity::kNeoHookean);
  for (const auto& [alpha, beta] :
       {std::pair(0.0, 0.0), std::pair(8.0, 0.0), std::pair(0.0, 0.1)}) {
    const SoftBody b = body(order, elasticity, alpha, beta);
    const BodyState state = some_state(b);
    const Eigen::VectorXd force = b.internal_force(state);
    CAPTURE(alpha, beta);
    CHECK(resultant(force).norm() < 1e-12 * force.norm());
    CHECK(torque(b, state, force).norm() < 1e-12 * force.norm());
  }
}

TEST_CASE("a turned undeformed body feels no force and its rigid velocity no damping") {
  const int order = GENERATE(1, 2);
  const auto elasticity = GENERATE(Elasticity::kCorotational, Elasticity::kNeoHookean);
  const SoftBody b = body(order, elasticity, 8.0, 0.1);
  const Matrix3 Q = Eigen::AngleAxisd(2.0, Vector3(1, 2, -3).normalized()).matrix();
  const Points x = b.rest() * Q.transpose();
  const Points v =
      (x * skew(Vector3(3, -2, 1)).transpose()).rowwise() + Eigen::RowVector3d(1, 2, 3);
  const BodyState state{(x - b.rest()).reshaped<Eigen::RowMajor>(), v.reshaped<Eigen::RowMajor>()};
  CHECK(b.internal_force(state).norm() < 1e-11);
}

TEST_CASE("damping takes power at any strain, and near rest it is beta K v") {
  const int order = GENERATE(1, 2);
  const auto elasticity = GENERATE(Elasticity::kCorotational, Elasticity::kNeoHookean);
  const SoftBody b = body(order, elasticity, 0.0, 0.1);
  const SoftBody undamped = body(order, elasticity, 0.0, 0.0);
  BodyState state = some_state(b);
  CHECK(state.v.dot(b.internal_force(state) - undamped.internal_force(state)) < 0.0);
  state.u.setZero();
  const Eigen::VectorXd expected = -0.1 * (b.stiffness(state.u) * state.v);
  CHECK((b.internal_force(state) - expected).norm() < 1e-12 * expected.norm());
}

TEST_CASE("warped stiffness is the Jacobian of the corotational force where there is no strain") {
  const int order = GENERATE(1, 2);
  const SoftBody b = body(order, Elasticity::kCorotational, 0.0, 0.0);
  const Matrix3 Q = Eigen::AngleAxisd(2.0, Vector3(1, 2, -3).normalized()).matrix();
  const Eigen::VectorXd u = (b.rest() * Q.transpose() - b.rest()).reshaped<Eigen::RowMajor>();
  const Eigen::VectorXd d = some_state(b).v;
  const double step = 1e-7;
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(u.size());
  const Eigen::VectorXd slope =
      (b.internal_force({u + step * d, none}) - b.internal_force({u - step * d, none})) /
      (2.0 * step);
  CHECK((slope + b.stiffness(u) * d).norm() < 1e-5 * slope.norm());
}

TEST_CASE("neo-Hookean stiffness is the Jacobian of the force at any strain") {
  const int order = GENERATE(1, 2);
  const SoftBody b = body(order, Elasticity::kNeoHookean, 0.0, 0.0);
  const BodyState state = some_state(b);
  const double step = 1e-7;
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(state.u.size());
  const Eigen::VectorXd slope = (b.internal_force({state.u + step * state.v, none}) -
                                 b.internal_force({state.u - step * state.v, none})) /
                                (2.0 * step);
  CHECK((slope + b.stiffness(state.u) * state.v).norm() < 1e-5 * slope.norm());
}
