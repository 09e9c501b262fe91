#include <bit>
#include <cmath>
#include <cstdint>
#include <random>
#include <utility>

#include "simulation/engine/active_modes.hpp"
#include "simulation/engine/course_kernels.hpp"
#include "simulation/engine/force_history.hpp"
#include "simulation/engine/kernels.hpp"
#include "simulation/engine/wide_kernels.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;

namespace {

std::vector<double> random_numbers(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<double> numbers(count);
  for (double& number : numbers) number = uniform(random);
  return numbers;
}

// The order of sums that kernels.hpp promises, whatever registers the processor has.
template <typename Term>
double sum_in_eight_lanes(std::size_t n, const Term& term) {
  std::array<double, 8> lanes{};
  std::size_t i = 0;
  for (; i < n / 8 * 8; ++i) lanes[i % 8] += term(i);
  double sum = ((lanes[0] + lanes[4]) + (lanes[1] + lanes[5])) +
               ((lanes[2] + lanes[6]) + (lanes[3] + lanes[7]));
  for (; i < n; ++i) sum += term(i);
  return sum;
}

}  // namespace

TEMPLATE_TEST_CASE("products of rows are those of each row, to the bit, whatever is left over", "",
                   float, double) {
  constexpr std::size_t kStride = 71;
  constexpr std::size_t kCount = 11;
  std::vector<TestType> rows;
  for (const double number : random_numbers(kStride * kCount, 1)) {
    rows.push_back(static_cast<TestType>(number));
  }
  const std::vector<double> x = random_numbers(kStride, 2);
  for (const std::size_t n : {0UL, 1UL, 7UL, 8UL, 33UL, 64UL, 71UL}) {
    for (const std::size_t count : {1UL, 3UL, 4UL, 11UL}) {
      std::vector<double> y(kCount, 0.25);
      add_products({rows.data(), kStride, count}, x.data(), n, 0.5, y.data());
      for (std::size_t r = 0; r < kCount; ++r) {
        const double product = dot(rows.data() + r * kStride, x.data(), n);
        REQUIRE(y[r] == (r < count ? 0.25 + 0.5 * product : 0.25));
        double direct = 0.0;
        for (std::size_t i = 0; i < n; ++i)
          direct += static_cast<double>(rows[r * kStride + i]) * x[i];
        REQUIRE(product == Approx(direct).margin(1e-13));
      }
    }
  }
}

TEMPLATE_TEST_CASE("steps ahead are the products of x with the rows, further and further on", "",
                   float, double) {
  constexpr std::size_t kStride = 1100;
  std::vector<TestType> rows;
  for (const double number : random_numbers(3 * kStride, 11)) {
    rows.push_back(static_cast<TestType>(number));
  }
  const std::vector<double> x = random_numbers(1060, 12);
  for (const std::size_t known : {0UL, 1UL, 15UL, 16UL, 17UL, 80UL, 200UL, 512UL, 530UL, 1050UL}) {
    for (const std::size_t n : {0UL, 1UL, 5UL, 64UL, 65UL, 150UL, 200UL, 498UL, 520UL, 1060UL}) {
      std::array<std::array<double, kStepsAhead>, 3> y;
      for (auto& row : y) row.fill(0.25);
      add_ahead(NodeRows<TestType>{rows.data(), kStride, known}, std::span(x).first(n), 0.5,
                {y[0].data(), y[1].data(), y[2].data()});
      for (std::size_t at = 0; at < 3 * kStepsAhead; ++at) {
        const std::size_t r = at / kStepsAhead;
        const std::size_t m = at % kStepsAhead;
        double direct = 0.0;
        for (std::size_t i = 0; i < n && m + i < known; ++i) {
          direct += static_cast<double>(rows[r * kStride + m + i]) * x[i];
        }
        REQUIRE(y[r][m] == Approx(0.25 + 0.5 * direct).margin(1e-13));
      }
    }
  }
}

TEMPLATE_TEST_CASE("the effect of a force is its products with nine rows", "", float, double) {
  constexpr std::size_t kRow = 210;
  constexpr std::size_t kColumn = 4 * kRow;
  constexpr std::size_t kRoom = 256;
  std::vector<TestType> numbers;
  for (const double number : random_numbers(3 * kColumn, 19)) {
    numbers.push_back(static_cast<TestType>(number));
  }
  const std::array force{0.5, -2.0, 0.3};
  for (const std::size_t known : {0UL, 1UL, 7UL, 8UL, 9UL, 64UL, 67UL, 130UL, 200UL}) {
    for (const std::size_t n : {0UL, 1UL, 5UL, 8UL, 17UL, 64UL, 65UL, 100UL, 200UL}) {
      std::array<std::array<double, kRoom>, 3> y;
      for (auto& row : y) row.fill(0.25);
      // What is not known is not read: it would be seen.
      std::vector<TestType> rows = numbers;
      for (std::size_t at = 0; at < rows.size(); ++at) {
        if (at % kRow >= known) rows[at] = static_cast<TestType>(1e4);
      }
      add_effect(NodeColumns<TestType>{rows.data(), kRow, kColumn, known}, force,
                 {y[0].data(), y[1].data(), y[2].data()}, n);
      for (std::size_t at = 0; at < 3 * kRoom; ++at) {
        const std::size_t r = at / kRoom;
        const std::size_t i = at % kRoom;
        if (i >= n && i < (n + 7) / 8 * 8) continue;  // means nothing
        double direct = 0.25;
        for (std::size_t c = 0; c < 3 && i < std::min(n, known); ++c) {
          direct += force[c] * static_cast<double>(rows[c * kColumn + r * kRow + i]);
        }
        REQUIRE(y[r][i] == Approx(direct).margin(1e-14));
      }
    }
  }
}

TEMPLATE_TEST_CASE("the effect of a force has the same bits whatever registers there are", "",
                   float, double) {
  constexpr std::size_t kKnown = 37;
  std::vector<TestType> rows;
  for (const double number : random_numbers(9 * kKnown, 20)) {
    rows.push_back(static_cast<TestType>(number));
  }
  const std::vector<double> before = random_numbers(3 * kKnown, 21);
  const std::array force{0.5, -2.1, 0.3};
  const NodeColumns<TestType> columns{rows.data(), kKnown, 3 * kKnown, kKnown};
  for (const WideKernels& kernels : wide_kernels()) {
    std::vector<double> y = before;
    const std::array<double*, 3> to{y.data(), y.data() + kKnown, y.data() + 2 * kKnown};
    if constexpr (std::is_same_v<TestType, float>) {
      kernels.add_effect_single(columns, force, to, kKnown);
    } else {
      kernels.add_effect_double(columns, force, to, kKnown);
    }
    for (std::size_t i = 0; i < y.size(); ++i) {
      const auto number = [&](std::size_t c) {
        return static_cast<double>(rows[3 * kKnown * c + i]);
      };
      const double sum = force[0] * number(0) + force[1] * number(1) + force[2] * number(2);
      REQUIRE(std::bit_cast<std::uint64_t>(y[i]) == std::bit_cast<std::uint64_t>(before[i] + sum));
    }
  }
}

TEST_CASE("a multiple is one but for rounding") {
  const std::size_t n = GENERATE(1UL, 8UL, 83UL);
  const std::vector<double> b = random_numbers(n, 22);
  std::vector<double> a;
  for (const double number : b) a.push_back(number / 3.0);
  CHECK(is_multiple(a.data(), 1.0 / 3.0, b.data(), n));
  CHECK(is_multiple(a.data(), 1.0, a.data(), n));
  CHECK_FALSE(is_multiple(a.data(), 0.3333, b.data(), n));
  const std::vector<double> none(n, 0.0);
  CHECK(is_multiple(none.data(), 2.0, none.data(), n));
  CHECK_FALSE(is_multiple(none.data(), 2.0, b.data(), n));
  CHECK_FALSE(is_multiple(b.data(), 2.0, none.data(), n));
  for (const std::size_t at : {std::size_t{0}, n / 2, n - 1}) {
    std::vector<double> other = a;
    other[at] += 1e-14;
    CHECK_FALSE(is_multiple(other.data(), 1.0 / 3.0, b.data(), n));
    for (const double none_at_all :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
      other[at] = none_at_all;
      CHECK_FALSE(is_multiple(other.data(), 1.0 / 3.0, b.data(), n));
    }
  }
}

TEST_CASE("moments of three rows, and of two times three, are the sums that they stand for") {
  constexpr std::size_t kModes = 43;
  const std::vector<double> a = random_numbers(3 * kModes, 3);
  const std::vector<double> b = random_numbers(3 * kModes, 4);
  const std::vector<double> w = random_numbers(kModes, 5);
  const std::vector<double> x = random_numbers(kModes, 6);
  using Rows3 = Eigen::Map<const Eigen::Matrix<double, 3, kModes, Eigen::RowMajor>>;
  using Row = Eigen::Map<const Eigen::Matrix<double, kModes, 1>>;
  const Eigen::Matrix3d own =
      Rows3(a.data()) * Row(w.data()).asDiagonal() * Rows3(a.data()).transpose();
  const Eigen::Matrix3d cross =
      Rows3(a.data()) * Row(w.data()).asDiagonal() * Rows3(b.data()).transpose();
  const Eigen::Vector3d products = Rows3(a.data()) * Row(x.data());
  const Sums<9> m = moments(a.data(), w.data(), x.data(), kModes);
  const Sums<9> c = cross_moments(a.data(), b.data(), w.data(), kModes);
  std::size_t p = 3;
  for (Eigen::Index j = 0; j < 3; ++j) {
    CHECK(m[static_cast<std::size_t>(j)] == Approx(products(j)));
    for (Eigen::Index k = 0; k < 3; ++k) {
      CHECK(c[static_cast<std::size_t>(3 * j + k)] == Approx(cross(j, k)));
      if (k <= j) CHECK(m[p++] == Approx(own(j, k)));
    }
  }
}

TEST_CASE("sums have the same bits whatever registers the processor has") {
  const std::size_t n = GENERATE(0UL, 5UL, 91UL);
  const std::vector<double> a = random_numbers(3 * n, 13);
  const std::vector<double> b = random_numbers(6 * n, 14);
  const std::vector<double> w = random_numbers(n, 15);
  const std::vector<double> x = random_numbers(n, 16);
  const auto check = [&](double sum, const auto& term) {
    REQUIRE(std::bit_cast<std::uint64_t>(sum) ==
            std::bit_cast<std::uint64_t>(sum_in_eight_lanes(n, term)));
  };
  check(dot(a.data(), x.data(), n), [&](std::size_t i) { return a[i] * x[i]; });
  std::vector<std::int16_t> integers(n);
  std::ranges::transform(x, integers.begin(),
                         [](double value) { return static_cast<std::int16_t>(30'000.0 * value); });
  check(dot(integers.data(), a.data(), n), [&](std::size_t i) { return integers[i] * a[i]; });
  for (const WideKernels& kernels : wide_kernels()) {
    const Sums<3> three = kernels.dot_three(x.data(), a.data(), n);
    const Sums<6> six = kernels.dot_six(x.data(), b.data(), n);
    const Sums<9> own = kernels.moments(a.data(), w.data(), x.data(), n);
    const Sums<9> cross = kernels.cross_moments(a.data(), b.data(), w.data(), n);
    for (std::size_t j = 0, p = 3; j < 3; ++j) {
      const double* row = a.data() + j * n;
      check(three[j], [&](std::size_t i) { return row[i] * x[i]; });
      check(own[j], [&](std::size_t i) { return row[i] * x[i]; });
      for (std::size_t k = 0; k < 3; ++k) {
        check(cross[3 * j + k], [&](std::size_t i) { return row[i] * w[i] * b[k * n + i]; });
        if (k <= j) check(own[p++], [&](std::size_t i) { return row[i] * w[i] * a[k * n + i]; });
      }
    }
    for (std::size_t k = 0; k < 6; ++k) {
      check(six[k], [&](std::size_t i) { return x[i] * b[k * n + i]; });
    }
  }
}

TEMPLATE_TEST_CASE("sums of steps ahead have the same bits whatever registers there are", "", float,
                   double) {
  constexpr std::size_t kPart = 512;  // numbers at a time, each with eight lanes of its own
  const std::size_t n = GENERATE(3UL, 91UL, 600UL);
  const std::size_t known = n + GENERATE(0UL, 40UL);
  std::vector<TestType> rows;
  for (const double number : random_numbers(3 * known, 17)) {
    rows.push_back(static_cast<TestType>(number));
  }
  const std::vector<double> x = random_numbers(n, 18);
  for (const WideKernels& kernels : wide_kernels()) {
    std::array<std::array<double, kStepsAhead>, 3> y{};
    const NodeRows<TestType> node{rows.data(), known, known};
    const std::array<double*, 3> to{y[0].data(), y[1].data(), y[2].data()};
    if constexpr (std::is_same_v<TestType, float>) {
      kernels.add_ahead_single(node, x, 1.0, to);
    } else {
      kernels.add_ahead_double(node, x, 1.0, to);
    }
    for (std::size_t at = 0; at < 3 * kStepsAhead; ++at) {
      const std::size_t r = at / kStepsAhead;
      const std::size_t m = at % kStepsAhead;
      double sum = 0.0;
      for (std::size_t begin = 0; begin < std::min(known, n + kStepsAhead - 1); begin += kPart) {
        sum += sum_in_eight_lanes(kPart, [&](std::size_t i) {
          const std::size_t j = begin + i;
          return j >= m && j - m < n && j < known
                     ? static_cast<double>(rows[r * known + j]) * x[j - m]
                     : 0.0;
        });
      }
      REQUIRE(std::bit_cast<std::uint64_t>(y[r][m]) == std::bit_cast<std::uint64_t>(sum));
    }
  }
}

TEST_CASE("silences and directions without force are left out of what is convolved") {
  constexpr int kSteps = 400;
  ForceHistory history(5, kSteps);
  const NodalForce both{2, Vector3(0, 1, 2)};
  const NodalForce one{4, Vector3(3, 0, 0)};
  // Ages at the end: 0..9 both; 90..99 both; 95 one, 200 one, both within 64 steps of nothing else.
  std::vector<std::vector<double>> expected(15, std::vector<double>(kSteps, 0.0));
  for (int age = 300; age >= 0; --age) {
    std::vector<NodalForce> now;
    const auto at = static_cast<std::size_t>(age);
    if (age < 10 || (age >= 90 && age < 100)) {
      now.push_back(both);
      expected[7][at] = 1.0;
      expected[8][at] = 2.0;
    }
    if (age == 95 || age == 120 || age == 200) {
      now.push_back(one);
      expected[12][at] = 3.0;
    }
    history.push(now);
  }
  std::vector<std::vector<double>> seen(15, std::vector<double>(kSteps, 0.0));
  std::size_t read = 0;
  for (const NonzeroInterval& stretch : nonzero_intervals(history)) {
    read += stretch.count;
    CHECK(stretch.force[0] != 0.0);
    CHECK(stretch.force[stretch.count - 1] != 0.0);
    for (std::size_t i = 0; i < stretch.count; ++i) {
      seen[stretch.column][stretch.first_age + i] += stretch.force[i];
    }
  }
  CHECK(seen == expected);
  // Two directions of two touches of 10 steps; 95 to 120 in one go, and 200 alone.
  CHECK(read == 2 * 2 * 10 + 26 + 1);
}

TEST_CASE("modes that are left out move no node by more than the tolerance") {
  constexpr std::size_t kModes = 1000;
  constexpr std::size_t kRows = 30;
  const std::vector<double> shapes = random_numbers(kRows * kModes, 8);
  std::vector<double> q = random_numbers(kModes, 9);
  for (std::size_t i = 0; i < kModes; ++i) q[i] *= std::exp(-0.01 * static_cast<double>(i));
  std::vector<double> largest(kModes, 0.0);
  for (std::size_t i = 0; i < kRows * kModes; ++i) {
    largest[i % kModes] = std::max(largest[i % kModes], std::abs(shapes[i]));
  }
  const double tolerance = GENERATE(0.0, 1e-9, 1e-4, 0.01, 0.3, 1e9);
  const std::vector<ModeRange> ranges = active_modes(q, largest, tolerance);
  std::vector<double> kept(kModes, 0.0);
  std::size_t last = 0;
  for (const ModeRange& range : ranges) {
    CHECK(range.first >= last);
    last = range.first + range.count;
    std::copy_n(q.begin() + static_cast<std::ptrdiff_t>(range.first), range.count,
                kept.begin() + static_cast<std::ptrdiff_t>(range.first));
  }
  double left_out = 0.0;
  for (std::size_t i = 0; i < kModes; ++i) left_out += std::abs(q[i] - kept[i]) * largest[i];
  CHECK(left_out <= tolerance);
  for (std::size_t r = 0; r < kRows; ++r) {
    const double all = dot(shapes.data() + r * kModes, q.data(), kModes);
    const double less = dot(shapes.data() + r * kModes, kept.data(), kModes);
    CHECK(std::abs(all - less) <= tolerance + 1e-12);
  }
  if (tolerance == 0.0) CHECK(ranges.size() == 1);
  if (tolerance == 0.3) CHECK(last < kModes);
  if (tolerance == 1e9) CHECK(ranges.empty());
}

TEST_CASE("courses of modes are summed by each kernel") {
  const std::size_t n = GENERATE(0UL, 8UL, 16UL, 256UL);
  const std::size_t steps = kCourse * GENERATE(1UL, 8UL);
  const std::size_t stride = n + 3;
  const std::vector<double> trace = random_numbers(n, 21);
  const std::vector<double> determinant = random_numbers(n, 22);
  const std::vector<double> begin = random_numbers(n, 23);
  const std::vector<double> then = random_numbers(n, 24);
  const std::vector<double> weights = random_numbers(3 * stride, 25);
  for (const AddCourses add : course_kernels()) {
    std::vector<double> now = begin;
    std::vector<double> next = then;
    std::vector<std::array<double, 3>> sums(steps, {0.5, -0.25, 0.0});
    add({trace.data(), determinant.data(), now.data(), next.data()}, weights.data(), stride, n,
        sums);
    std::vector<std::array<double, 3>> expected(steps, {0.5, -0.25, 0.0});
    for (std::size_t i = 0; i < n; ++i) {
      double x = begin[i];
      double after = then[i];
      for (std::size_t s = 0; s < steps; ++s) {
        for (std::size_t k = 0; k < 3; ++k) expected[s][k] += weights[k * stride + i] * x;
        x = std::exchange(after, trace[i] * after - determinant[i] * x);
      }
      CHECK(now[i] == Approx(x).margin(1e-12));
      CHECK(next[i] == Approx(after).margin(1e-12));
    }
    for (std::size_t s = 0; s < steps; ++s) {
      for (std::size_t k = 0; k < 3; ++k) {
        CHECK(sums[s][k] == Approx(expected[s][k]).margin(1e-12));
      }
    }
  }
}
