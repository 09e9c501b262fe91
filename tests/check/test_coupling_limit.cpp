#include "common/stability/coupling_limit.hpp"
#include "tests/check/oscillators.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;
using irdm::test::damped_modes;
using irdm::test::driving_point;

namespace {

constexpr double kLimitDt = 0.002;
const Matrix3 kLimitRigid =
    0.5 * kLimitDt * kLimitDt * Vector3(9.0, 6.0, 7.0).asDiagonal().toDenseMatrix();

// Hand and object step by step; the hand is integrated in small steps. Ratio of the forces late to
// those earlier: above one when the loop grows.
double simulated_growth(const DrivingPoint& record, const Matrix3& rigid, const HandLoop& loop,
                        double coupling, int steps) {
  std::vector<Vector3> force;
  std::vector<double> norms;
  Vector3 velocity = Vector3::Zero();
  Vector3 place = Vector3::Zero();
  Vector3 hand = Vector3(1e-3, -2e-3, 1e-3);
  Vector3 hand_velocity = Vector3::Zero();
  const Matrix3 inverse =
      (Matrix3(record.col(0).reshaped(3, 3)) + rigid + Matrix3::Identity() / coupling).inverse();
  for (int k = 0; k < steps; ++k) {
    const Vector3 felt = k >= loop.delay ? Vector3(-force[static_cast<std::size_t>(k - loop.delay)])
                                         : Vector3(Vector3::Zero());
    constexpr int kSubsteps = 200;
    const double h = kLimitDt / kSubsteps;
    for (int i = 0; i < kSubsteps; ++i) {  // velocity Verlet with the damper at the half step
      const auto acceleration = [&] {
        return Vector3((felt - loop.hand.stiffness * hand - loop.hand.damping * hand_velocity) /
                       loop.hand.mass);
      };
      hand_velocity += 0.5 * h * acceleration();
      hand += h * hand_velocity;
      hand_velocity += 0.5 * h * acceleration();
    }
    Vector3 free = place + velocity;
    for (int s = 1; s <= k && s < record.cols(); ++s) {
      free += record.col(s).reshaped(3, 3) * force[static_cast<std::size_t>(k - s)];
    }
    force.emplace_back(inverse * (hand - free));
    place += velocity + rigid * force.back();
    velocity += 2.0 * rigid * force.back();
    norms.push_back(force.back().norm());
  }
  const auto window = [&](int from) {
    double sum = 0.0;
    for (int k = from; k < from + 300; ++k) sum += norms[static_cast<std::size_t>(k)];
    return sum;
  };
  return window(steps - 300) / window(steps - 900);
}

}  // namespace

TEST_CASE("the transfer of the hand is its response to a held force") {
  const Hand hand;
  std::complex<double> sum = 0.0;
  const std::complex<double> w = std::polar(0.97, -0.4);
  const DrivingPoint response = driving_point(
      {{std::sqrt(hand.stiffness / hand.mass), 0.5 * hand.damping / hand.mass, Vector3::UnitX()}},
      kLimitDt, 2000);
  std::complex<double> power = 1.0;
  for (int s = 0; s < 2000; ++s, power *= w) sum += response(0, s) / hand.mass * power;
  CHECK(std::abs(hand_transfer(hand, kLimitDt, w) - sum) < 1e-10 * std::abs(sum));
}

TEST_CASE("a delay counts in whole steps, both ways, and one for the computation") {
  CHECK(loop_delay(0.0, kLimitDt) == 1);
  CHECK(loop_delay(0.002, kLimitDt) == 3);
  CHECK(loop_delay(0.0021, kLimitDt) == 5);
  CHECK(loop_delay(0.01, kLimitDt) == 11);
}

TEST_CASE("the loop is stable just below the largest coupling and grows just above it") {
  // Stiff enough that the delay is felt.
  auto modes = damped_modes();
  for (auto& mode : modes) mode.shape *= 0.3;
  const DrivingPoint record = driving_point(modes, kLimitDt, 800);
  const bool floating = GENERATE(true, false);
  const int delay = GENERATE(3, 11);
  const Matrix3 rigid = floating ? kLimitRigid : Matrix3(Matrix3::Zero());
  const HandLoop loop{{}, kLimitDt, delay};
  const double limit = largest_coupling(record, rigid, loop, 1.0);
  REQUIRE(limit > kSoftestCoupling);
  REQUIRE(limit < kStiffestCoupling);
  CHECK(simulated_growth(record, rigid, loop, 0.9 * limit, 3000) < 1.0);
  CHECK(simulated_growth(record, rigid, loop, 1.1 * limit, 3000) > 1.0);
}

TEST_CASE("a longer delay and a hand with less damping allow less coupling") {
  auto modes = damped_modes();
  for (auto& mode : modes) mode.shape *= 0.3;
  const DrivingPoint record = driving_point(modes, kLimitDt, 800);
  const double usual = largest_coupling(record, kLimitRigid, {{}, kLimitDt, 3}, 1.0);
  CHECK(largest_coupling(record, kLimitRigid, {{}, kLimitDt, 11}, 1.0) < usual);
  CHECK(largest_coupling(record, kLimitRigid, {{0.12, 0.5, 300.0}, kLimitDt, 3}, 1.0) < usual);
}

TEST_CASE("a soft body bears a stiff coupling, one that answers late a softer one") {
  const DrivingPoint good = driving_point(damped_modes(), kLimitDt, 800);
  const double limit = largest_coupling(good, kLimitRigid, {{}, kLimitDt, 1}, 1.0);
  CAPTURE(limit);
  CHECK(limit > 3e3);
  DrivingPoint late = DrivingPoint::Zero(9, 811);
  late.rightCols(800) = good;
  late.col(0) = 0.1 * good.col(0);
  CHECK(largest_coupling(late, kLimitRigid, {{}, kLimitDt, 1}, 1.0) < 0.9 * limit);
}
