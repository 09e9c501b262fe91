#include <set>

#include "precompute/check/reciprocity.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;
using namespace irdm::precompute;

namespace {

constexpr int kDof = 30;
constexpr int kSteps = 5;

// R[s](a, b) of a symmetric response whose diagonal dominates.
double response(int s, int a, int b) {
  return a == b ? 1.0 + s : 0.2 * std::sin(1.0 + a * b + a + b + s);
}

RowMatrix<double> column(int b) {
  RowMatrix<double> values(kSteps, kDof);
  for (int s = 0; s < kSteps; ++s) {
    for (int a = 0; a < kDof; ++a) values(s, a) = response(s, a, b);
  }
  return values;
}

Reciprocity sampled() {
  Reciprocity reciprocity;
  for (const int a : fixed_sample(kDof, 4)) reciprocity.remember(a, column(a));
  return reciprocity;
}

}  // namespace

TEST_CASE("a symmetric response is reciprocal but for single precision") {
  Reciprocity reciprocity = sampled();
  for (int b = 0; b < kDof; ++b) reciprocity.add(b, column(b));
  CHECK(reciprocity.largest_difference() < 1e-7);
}

TEST_CASE("a single column that is too large is found, whichever it is") {
  Reciprocity reciprocity = sampled();
  const int wrong = GENERATE(0, 7, 29);
  for (int b = 0; b < kDof; ++b) {
    reciprocity.add(b, b == wrong ? RowMatrix<double>(2.0 * column(b)) : column(b));
  }
  CHECK(reciprocity.largest_difference() > 0.01);
  CHECK(reciprocity.column_of_largest() == wrong);
}

TEST_CASE("what is not a number is not reciprocal") {
  Reciprocity reciprocity = sampled();
  RowMatrix<double> broken = column(3);
  broken.setConstant(std::numeric_limits<double>::quiet_NaN());
  reciprocity.add(3, broken);
  CHECK_FALSE(reciprocity.largest_difference() < 1.0);
}

TEST_CASE("a sample is fixed, has no number twice and is no larger than what there is") {
  const std::vector<int> sample = fixed_sample(1000, 16);
  CHECK(sample == fixed_sample(1000, 16));
  CHECK(std::set<int>(sample.begin(), sample.end()).size() == 16);
  CHECK(sample.front() >= 0);
  CHECK(sample.back() < 1000);
  CHECK(fixed_sample(3, 16) == std::vector<int>{0, 1, 2});
}
