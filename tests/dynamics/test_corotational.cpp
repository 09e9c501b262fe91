#include "precompute/dynamics/corotational.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;
using namespace irdm::precompute;

namespace {

const Lame kLame{1300.0, 770.0};
constexpr double kStep = 1e-3;

Matrix3 turned(double angle, const Matrix3& stretch) {
  return Eigen::AngleAxisd(angle, Vector3(1, -2, 0.5).normalized()) * stretch;
}

// Two states of an element: turned by half a radian in between, with strains of `size`.
std::pair<Matrix3, Matrix3> two_states(double size) {
  std::srand(1);
  const Matrix3 before = turned(0.3, Matrix3::Identity() + size * Matrix3::Random());
  const Matrix3 after = turned(0.8, Matrix3::Identity() + size * Matrix3::Random());
  return {before - Matrix3::Identity(), after - Matrix3::Identity()};
}

double work(const Matrix3& P, const Matrix3& before, const Matrix3& after) {
  return P.cwiseProduct(after - before).sum();
}

double energy(const Matrix3& du_dX) {
  return corotational::energy_density(corotational::strain(du_dX), kLame);
}

}  // namespace

TEST_CASE("the work of the undamped mean stress is the change of energy, at any strain and turn") {
  for (const double size : {0.3, 0.1, 1e-3}) {
    const auto [before, after] = two_states(size);
    const Matrix3 P =
        corotational::mean_stress(before, corotational::strain(before), after, kStep, kLame, 0.0);
    CHECK(work(P, before, after) ==
          Approx(energy(after) - energy(before)).epsilon(1e-10).margin(1e-13 * P.norm()));
  }
}

TEST_CASE("damping in the mean stress takes beta/h T(e1 - e0) : (e1 - e0)") {
  const double beta = 2e-4;
  const auto [before, after] = two_states(0.2);
  const Matrix3 e0 = corotational::strain(before);
  const Matrix3 de = corotational::strain(after) - e0;
  const Matrix3 P = corotational::mean_stress(before, e0, after, kStep, kLame, beta);
  const double taken = beta / kStep * lame_stress(de, kLame).cwiseProduct(de).sum();
  CHECK(taken > 0.0);
  CHECK(work(P, before, after) == Approx(energy(after) - energy(before) + taken).epsilon(1e-11));
}

TEST_CASE("the mean stress has no torque about the middle of the step") {
  const auto [before, after] = two_states(0.2);
  const Matrix3 P =
      corotational::mean_stress(before, corotational::strain(before), after, kStep, kLame, 2e-4);
  const Matrix3 middle = Matrix3::Identity() + 0.5 * (before + after);
  const Matrix3 kirchhoff = P * middle.transpose();
  CHECK((kirchhoff - kirchhoff.transpose()).norm() < 1e-13 * kirchhoff.norm());
}

TEST_CASE("for short steps the mean stress is that of the moment, damping included") {
  const double beta = 2e-4;
  const auto [du_dX, unused] = two_states(0.2);
  std::srand(2);
  const Matrix3 rate = 10.0 * Matrix3::Random();
  const Matrix3 now = corotational::stress(du_dX, rate, kLame, beta);
  std::vector<double> errors;
  for (const double h : {1e-3, 5e-4}) {
    const Matrix3 before = du_dX - 0.5 * h * rate;
    const Matrix3 mean = corotational::mean_stress(before, corotational::strain(before),
                                                   du_dX + 0.5 * h * rate, h, kLame, beta);
    errors.push_back((mean - now).norm() / now.norm());
  }
  CHECK(errors[1] < 1e-4);
  CHECK(errors[0] / errors[1] == Approx(4.0).epsilon(0.02));
}
