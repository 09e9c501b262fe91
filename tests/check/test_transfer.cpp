#include "common/stability/transfer.hpp"
#include "tests/check/oscillators.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;

namespace {

// Coefficients of the product of (1 - w / zero) over conjugate pairs, on the diagonal.
DrivingPoint with_zeros(const std::vector<std::complex<double>>& pairs) {
  std::vector<double> polynomial{1.0};
  for (const auto& zero : pairs) {
    const double linear = -2.0 * zero.real() / std::norm(zero);
    const double square = 1.0 / std::norm(zero);
    std::vector<double> next(polynomial.size() + 2, 0.0);
    for (std::size_t i = 0; i < polynomial.size(); ++i) {
      next[i] += polynomial[i];
      next[i + 1] += linear * polynomial[i];
      next[i + 2] += square * polynomial[i];
    }
    polynomial = next;
  }
  DrivingPoint record = DrivingPoint::Zero(9, static_cast<Eigen::Index>(polynomial.size()));
  for (std::size_t s = 0; s < polynomial.size(); ++s) {
    record.col(static_cast<Eigen::Index>(s)) = polynomial[s] * Matrix3::Identity().reshaped();
  }
  return record;
}

int zeros_of_entry(const DrivingPoint& record, double radius) {
  return count_zeros(transform(record, radius, 1024), radius,
                     [](const Eigen::Matrix3cd& r, std::complex<double>) { return r(0, 0); })
      .zeros;
}

int zeros_of_determinant(const DrivingPoint& record, double radius) {
  return count_zeros(
             transform(record, radius, 1024), radius,
             [](const Eigen::Matrix3cd& r, std::complex<double>) { return r.determinant(); })
      .zeros;
}

}  // namespace

TEST_CASE("the transform is the sum of the series on the circle") {
  const DrivingPoint record = test::driving_point(test::damped_modes(), 0.002, 300);
  for (const double radius : {0.9, 1.0, 1.02}) {
    const MatrixHalfCircle values = transform(record, radius, 128);  // shorter than the record
    for (const int j : {0, 1, 50, 128}) {
      const std::complex<double> w = std::polar(radius, -3.14159265358979324 * j / 128);
      Eigen::Matrix3cd sum = Eigen::Matrix3cd::Zero();
      std::complex<double> power = 1.0;
      for (int s = 0; s < 300; ++s, power *= w) sum += power * record.col(s).reshaped(3, 3);
      CHECK((values[static_cast<std::size_t>(j)] - sum).norm() < 1e-10 * sum.norm());
    }
  }
}

TEST_CASE("zeros inside a circle are counted") {
  const DrivingPoint record = with_zeros({{0.3, 0.6}, {-0.9, 0.1}, {1.2, 0.5}});
  CHECK(zeros_of_entry(record, 0.5) == 0);
  CHECK(zeros_of_entry(record, 0.8) == 2);
  CHECK(zeros_of_entry(record, 1.0) == 4);
  CHECK(zeros_of_entry(record, 1.4) == 6);
}

TEST_CASE("zeros are counted on the right side of a circle that they nearly touch") {
  const double gap = GENERATE(1e-3, 1e-4, 1e-5);
  const double angle = GENERATE(0.004, 0.5, 3.1);
  CHECK(zeros_of_entry(with_zeros({std::polar(1.0 - gap, angle)}), 1.0) == 2);
  CHECK(zeros_of_entry(with_zeros({std::polar(1.0 + gap, angle)}), 1.0) == 0);
  // Three times the same zero, as a body has that answers alike in all directions.
  CHECK(zeros_of_determinant(with_zeros({std::polar(1.0 - gap, angle)}), 1.0) == 6);
  CHECK(zeros_of_determinant(with_zeros({std::polar(1.0 + gap, angle)}), 1.0) == 0);
}

TEST_CASE("zeros of noise are not counted for ever, and are said to be unknown") {
  const MatrixHalfCircle response(1025, Eigen::Matrix3cd::Identity());
  long calls = 0;
  // Another argument at every point, however near.
  const ZeroCount found =
      count_zeros(response, 1.0, [&](const Eigen::Matrix3cd&, std::complex<double>) {
        ++calls;
        return std::polar(1.0, 2.4 * static_cast<double>(calls % 97));
      });
  CHECK_FALSE(found.resolved);
  CHECK(calls <= 2 * 1024 + kMostTurns + 1024 + 1);
}
