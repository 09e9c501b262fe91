#include <numbers>

#include "precompute/dynamics/rigid_extraction.hpp"
#include "precompute/dynamics/soft_body.hpp"
#include "tests/precompute/meshes.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;
using namespace irdm::precompute;

namespace {

const Material kMovedMaterial{2000.0, 0.3, 110.0, 8.0, 2e-4};

SoftBody some_body() {
  return {test::box_mesh(Vector3(0.12, 0.08, 0.10), {3, 2, 2}), kMovedMaterial,
          Elasticity::kCorotational};
}

Points moved(const Points& rest, const Matrix3& Q, const Vector3& translation, const Points& e) {
  return ((rest + e) * Q.transpose() - rest).rowwise() + translation.transpose();
}

}  // namespace

TEST_CASE("an undeformed body has no elastic part after any rotation and translation") {
  const SoftBody body = some_body();
  const Points none = Points::Zero(body.node_count(), 3);
  const Vector3 translation(0.3, -0.2, 1.1);
  for (const auto weights : {RotationWeights::kMass, RotationWeights::kNone}) {
    for (const double degrees : {0.0, 1e-6, 1.0, 45.0, 90.0, 135.0, 179.0, 180.0}) {
      for (const Vector3& axis : {Vector3(1, 0, 0), Vector3(0, 1, 0), Vector3(1, 2, -3)}) {
        CAPTURE(degrees, axis.transpose());
        const Matrix3 Q =
            Eigen::AngleAxisd(degrees * std::numbers::pi / 180.0, axis.normalized()).matrix();
        const Points u = moved(body.rest(), Q, translation, none);
        const RigidMotion motion = extract_rigid_motion(body.rest(), u, body.mass(), weights);
        CHECK((motion.rotation - Q).norm() < 1e-12);
        CHECK((motion.translation - translation).norm() < 1e-12);
        CHECK(elastic_part(body.rest(), u, motion).cwiseAbs().maxCoeff() < 1e-12);
      }
    }
  }
}

TEST_CASE("the mass-weighted elastic part has no momentum, the unweighted one has") {
  const SoftBody body = some_body();
  std::srand(1);
  const Points deformation = 0.005 * Points::Random(body.node_count(), 3);
  const Matrix3 Q = Eigen::AngleAxisd(2.9, Vector3(1, 2, -3).normalized()).matrix();
  const Points u = moved(body.rest(), Q, Vector3(1, 2, 3), deformation);
  const auto momenta = [&](const Points& e) {
    Vector3 linear = Vector3::Zero();
    Vector3 angular = Vector3::Zero();
    for (Eigen::Index i = 0; i < e.rows(); ++i) {
      linear += body.mass()(i) * e.row(i).transpose();
      angular += body.mass()(i) * Vector3(body.rest().row(i)).cross(Vector3(e.row(i)));
    }
    return std::pair(linear.norm(), angular.norm());
  };
  const auto elastic = [&](RotationWeights weights) {
    return elastic_part(body.rest(), u, extract_rigid_motion(body.rest(), u, body.mass(), weights));
  };
  const double size = body.mass().sum() * 0.005;
  const auto [linear, angular] = momenta(elastic(RotationWeights::kMass));
  CHECK(linear < 1e-12 * size);
  CHECK(angular < 1e-12 * size);
  CHECK(momenta(elastic(RotationWeights::kNone)).second > 1e-6 * size);
  const auto [linear_small, angular_small] =
      momenta(linear_elastic_part(body.rest(), u, body.mass(), RotationWeights::kMass));
  CHECK(linear_small < 1e-12);
  CHECK(angular_small < 1e-12);
}

TEST_CASE("unweighted rotation minimises the sum of squared distances") {
  const SoftBody body = some_body();
  std::srand(2);
  const Points u = moved(body.rest(), Eigen::AngleAxisd(1.0, Vector3::UnitY()).matrix(),
                         Vector3::Zero(), 0.01 * Points::Random(body.node_count(), 3));
  RigidMotion motion = extract_rigid_motion(body.rest(), u, body.mass(), RotationWeights::kNone);
  const double best = elastic_part(body.rest(), u, motion).squaredNorm();
  const Matrix3 Q = motion.rotation;
  for (const double angle : {-1e-3, 1e-3}) {
    for (int axis = 0; axis < 3; ++axis) {
      motion.rotation = Q * Eigen::AngleAxisd(angle, Vector3::Unit(axis)).matrix();
      CHECK(elastic_part(body.rest(), u, motion).squaredNorm() > best);
    }
  }
}

TEST_CASE("linear extraction is the limit of the finite one") {
  const SoftBody body = some_body();
  std::srand(3);
  const Points u = 1e-7 * Points::Random(body.node_count(), 3);
  for (const auto weights : {RotationWeights::kMass, RotationWeights::kNone}) {
    const Points finite =
        elastic_part(body.rest(), u, extract_rigid_motion(body.rest(), u, body.mass(), weights));
    CHECK((finite - linear_elastic_part(body.rest(), u, body.mass(), weights)).norm() <
          1e-4 * u.norm());
  }
}
