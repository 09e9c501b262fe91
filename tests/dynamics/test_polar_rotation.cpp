#include "precompute/dynamics/corotational.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;
using namespace irdm::precompute;

namespace {

Matrix3 some_rotation() {
  return Eigen::AngleAxisd(2.5, Vector3(1, -2, 0.5).normalized()).toRotationMatrix();
}

}  // namespace

TEST_CASE("polar rotation undoes any stretch") {
  Matrix3 stretch;
  for (const double small : {1.0, 0.999, 0.3, 1e-4}) {
    stretch << 1.2, 0.1, 0, 0.1, small + 0.02, 0, 0, 0, 2;
    CHECK((polar_rotation(some_rotation() * stretch) - some_rotation()).norm() < 1e-11);
  }
}

TEST_CASE("polar rotation of an inverted or flat matrix is a proper rotation") {
  const Matrix3 inverted = some_rotation() * Vector3(1, 0.8, -0.2).asDiagonal();
  const Matrix3 flat = some_rotation() * Vector3(1, 0.8, 0).asDiagonal();
  for (const Matrix3& F : {inverted, flat}) {
    const Matrix3 Q = polar_rotation(F);
    CHECK((Q.transpose() * Q - Matrix3::Identity()).norm() < 1e-13);
    CHECK(Q.determinant() == Approx(1.0));
    CHECK((Q - some_rotation()).norm() < 1e-12);
  }
}
