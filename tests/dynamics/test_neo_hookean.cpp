#include "precompute/dynamics/neo_hookean.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;
using namespace irdm::precompute;

namespace {

const Lame kNeoLame{1300.0, 770.0};
constexpr double kNeoStep = 1e-3;

Matrix3 turn(double angle) {
  return Eigen::AngleAxisd(angle, Vector3(1, -2, 0.5).normalized()).toRotationMatrix();
}

// Two states of an element: turned by half a radian in between, with strains of `size`.
std::pair<Matrix3, Matrix3> two_neo_states(double size) {
  std::srand(1);
  const Matrix3 before = turn(0.3) * (Matrix3::Identity() + size * Matrix3::Random());
  const Matrix3 after = turn(0.8) * (Matrix3::Identity() + size * Matrix3::Random());
  return {before - Matrix3::Identity(), after - Matrix3::Identity()};
}

Matrix3 neo_stress(const Matrix3& du_dX) {
  return neo_hookean::stress(du_dX, Matrix3::Zero(), kNeoLame, 0.0);
}

double neo_work(const Matrix3& P, const Matrix3& before, const Matrix3& after) {
  return P.cwiseProduct(after - before).sum();
}

double neo_energy(const Matrix3& du_dX) {
  return neo_hookean::energy_density(du_dX, kNeoLame);
}

}  // namespace

// Cauchy stress P F^T / J of F = Id + g e1 e2^T: mu g in shear, and mu g^2 along e1 (Poynting).
TEST_CASE("neo-Hookean simple shear is the textbook's, turned or not") {
  for (const double g : {1e-6, 0.1, 1.5}) {
    Matrix3 shear = Matrix3::Identity();
    shear(0, 1) = g;
    const Matrix3 Q = turn(1.1);
    const Matrix3 F = Q * shear;
    Matrix3 expected = Matrix3::Zero();
    expected(0, 1) = expected(1, 0) = kNeoLame.mu * g;
    expected(0, 0) = kNeoLame.mu * g * g;
    const Matrix3 cauchy = neo_stress(F - Matrix3::Identity()) * F.transpose();
    CHECK((cauchy - Q * expected * Q.transpose()).norm() < 1e-9 * expected.norm());
  }
}

// Cauchy pressure of F = a Id: (mu (a^2 - 1) + 3 lambda ln a) / a^3.
TEST_CASE("neo-Hookean swelling is the textbook's") {
  for (const double a : {0.5, 0.99, 1.0001, 2.0}) {
    const Matrix3 F = a * Matrix3::Identity();
    const Matrix3 cauchy = neo_stress(F - Matrix3::Identity()) * F.transpose() / (a * a * a);
    const double expected =
        (kNeoLame.mu * (a * a - 1.0) + 3.0 * kNeoLame.lambda * std::log(a)) / (a * a * a);
    CHECK((cauchy - expected * Matrix3::Identity()).norm() < 1e-11 * std::abs(expected));
  }
}

TEST_CASE("neo-Hookean stress of small strains is the linear one, damping included") {
  std::srand(1);
  const Matrix3 H = 1e-7 * Matrix3::Random();
  const Matrix3 rate = 1e-4 * Matrix3::Random();
  const double beta = 2e-4;
  const Matrix3 P = neo_hookean::stress(H, rate, kNeoLame, beta);
  const Matrix3 linear = lame_stress(H + beta * rate, kNeoLame);
  CHECK((P - linear).norm() < 1e-6 * linear.norm());
}

TEST_CASE("the work of the neo-Hookean mean stress is the change of energy") {
  for (const double size : {0.3, 0.1, 1e-3}) {
    const auto [before, after] = two_neo_states(size);
    const Matrix3 P = neo_hookean::mean_stress(before, after, kNeoStep, kNeoLame, 0.0);
    CHECK(neo_work(P, before, after) ==
          Approx(neo_energy(after) - neo_energy(before)).epsilon(1e-10).margin(1e-13 * P.norm()));
  }
}

TEST_CASE("neo-Hookean damping takes beta/h T(E1 - E0) : (E1 - E0), and there is no torque") {
  const double beta = 2e-4;
  const auto [before, after] = two_neo_states(0.2);
  const auto green = [](const Matrix3& H) -> Matrix3 {
    return 0.5 * (H + H.transpose() + H.transpose() * H);
  };
  const Matrix3 dE = green(after) - green(before);
  const Matrix3 P = neo_hookean::mean_stress(before, after, kNeoStep, kNeoLame, beta);
  const double taken = beta / kNeoStep * lame_stress(dE, kNeoLame).cwiseProduct(dE).sum();
  CHECK(taken > 0.0);
  CHECK(neo_work(P, before, after) ==
        Approx(neo_energy(after) - neo_energy(before) + taken).epsilon(1e-11));
  const Matrix3 kirchhoff = P * (Matrix3::Identity() + 0.5 * (before + after)).transpose();
  CHECK((kirchhoff - kirchhoff.transpose()).norm() < 1e-13 * kirchhoff.norm());
}

TEST_CASE("for short steps the neo-Hookean mean stress is that of the moment") {
  const double beta = 2e-4;
  const auto [du_dX, unused] = two_neo_states(0.2);
  std::srand(2);
  const Matrix3 rate = 10.0 * Matrix3::Random();
  const Matrix3 now = neo_hookean::stress(du_dX, rate, kNeoLame, beta);
  std::vector<double> errors;
  for (const double h : {1e-3, 5e-4}) {
    const Matrix3 mean =
        neo_hookean::mean_stress(du_dX - 0.5 * h * rate, du_dX + 0.5 * h * rate, h, kNeoLame, beta);
    errors.push_back((mean - now).norm() / now.norm());
  }
  CHECK(errors[1] < 1e-4);
  CHECK(errors[0] / errors[1] == Approx(4.0).epsilon(0.02));
}

TEST_CASE("an element inside out has no neo-Hookean stress") {
  Matrix3 H = Matrix3::Zero();
  H(0, 0) = -1.5;
  CHECK(neo_stress(H).hasNaN());
  CHECK(std::isnan(neo_energy(H)));
  CHECK(neo_hookean::mean_stress(Matrix3::Zero(), H, kNeoStep, kNeoLame, 0.0).hasNaN());
}
