#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "common/error.hpp"
#include "common/half.hpp"
#include "common/model/half_column.hpp"
#include "common/model/model_file.hpp"
#include "common/realtime/no_denormals.hpp"
#include "tests/common/one_tet_model.hpp"
#include "tests/support/temporary_folder.hpp"

using Catch::Matchers::Contains;
using namespace irdm;

namespace {

// The value of a pattern as IEEE 754 defines it.
double defined_value(unsigned bits) {
  const int exponent = static_cast<int>((bits >> 10) & 31U);
  const int fraction = static_cast<int>(bits & 1023U);
  const double magnitude =
      exponent == 0 ? std::ldexp(fraction, -24) : std::ldexp(1024 + fraction, exponent - 25);
  return (bits & 0x8000U) != 0 ? -magnitude : magnitude;
}

// How many of all finite patterns are not what they mean, or do not come back.
int wrong_patterns() {
  int wrong = 0;
  for (unsigned bits = 0; bits < 0x10000U; ++bits) {
    if ((bits & 0x7C00U) == 0x7C00U) continue;  // not finite
    const Half half{static_cast<std::uint16_t>(bits)};
    if (to_double(half) != defined_value(bits)) ++wrong;
    if (to_half(to_float(half)).bits != bits) ++wrong;
  }
  return wrong;
}

}  // namespace

TEST_CASE("every number of half precision is read as IEEE 754 defines it, and comes back") {
  CHECK(wrong_patterns() == 0);
}

TEST_CASE("numbers of half precision mean the same where denormal numbers are zero") {
  const NoDenormals guard;
  int wrong = 0;
  for (unsigned bits = 0; bits < 0x7C00U; ++bits) {
    if (to_double(Half{static_cast<std::uint16_t>(bits)}) != defined_value(bits)) ++wrong;
  }
  CHECK(wrong == 0);
}

TEST_CASE("numbers are rounded to the nearest of half precision, the even one of two") {
  CHECK(to_half(1.0F).bits == 0x3C00);
  CHECK(to_half(1.0F + 0x1p-11F).bits == 0x3C00);     // half-way, down to even
  CHECK(to_half(1.0F + 0x3p-11F).bits == 0x3C02);     // half-way, up to even
  CHECK(to_half(1.0F + 0x1.01p-11F).bits == 0x3C01);  // just above half-way
  CHECK(to_half(0x1p-25F).bits == 0);                 // half of the smallest, down to even
  CHECK(to_half(0x1.01p-25F).bits == 1);
  CHECK(to_half(0x1.FFFp-15F).bits == 0x0400);  // up to the lowest normal number
  CHECK(to_half(65504.0F).bits == 0x7BFF);
  CHECK(to_half(-2.0F).bits == 0xC000);
  std::mt19937 random(5);
  std::uniform_real_distribution<float> exponent(-13.9F, 15.0F);
  for (int i = 0; i < 10'000; ++i) {
    const float value = std::exp2(exponent(random));
    REQUIRE(std::abs(to_float(to_half(value)) - value) <= 0x1p-11F * value);
  }
}

TEST_CASE("a column in half precision: scaled by a power of two, error as it is") {
  RowMatrix<double> column(3, 2);
  column << 0.004, -0.001, 2e-9, 0.0, 1e-3, 3e-5;
  const HalfColumn half = half_column(column);
  CHECK(std::exp2(std::round(std::log2(half.scale))) == half.scale);
  CHECK(0.004 / half.scale >= 16384.0);
  CHECK(0.004 / half.scale < 32768.0);
  double largest = 0.0;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (Eigen::Index i = 0; i < column.size(); ++i) {
    const double stored = half.scale * to_double(half.numbers[static_cast<std::size_t>(i)]);
    CHECK(std::abs(stored - column.data()[i]) <= 0x1p-11 * std::abs(column.data()[i]));
    largest = std::max(largest, std::abs(stored - column.data()[i]));
    sum[i % 2] += stored - column.data()[i];
  }
  CHECK(half.error.entry == Approx(largest / 0.004));
  CHECK(half.error.compliance ==
        Approx(sum.cwiseAbs().maxCoeff() / column.colwise().sum().cwiseAbs().maxCoeff()));
  const HalfColumn nothing = half_column(RowMatrix<double>::Zero(2, 2));
  CHECK(nothing.error.entry == 0.0);
  CHECK(nothing.numbers[0].bits == 0);
}

TEST_CASE("dense R of half precision is written and read, with its error in the file") {
  constexpr int kSteps = 7;
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "model.h5";
  const Model model = test::one_tet_model(kSteps);
  const int dof = model.degrees_of_freedom();
  std::mt19937 random(6);
  std::normal_distribution<float> normal(0.0F, 1e-3F);
  std::vector<Eigen::MatrixXf> R;  // by steps
  for (int s = 0; s < kSteps; ++s) {
    const Eigen::MatrixXf part =
        Eigen::MatrixXf::NullaryExpr(dof, dof, [&] { return normal(random); });
    R.emplace_back(part + part.transpose()).diagonal() = part.diagonal().cwiseAbs();
  }
  std::vector<RowMatrix<float>> columns;
  HalfError error;
  {
    ModelFileWriter writer(path);
    writer.write_description(model);
    writer.begin_dense_half(dof, kSteps);
    for (int b = 0; b < dof; ++b) {
      columns.emplace_back(RowMatrix<float>::NullaryExpr(
          kSteps, dof,
          [&](Eigen::Index s, Eigen::Index a) { return R[static_cast<std::size_t>(s)](a, b); }));
      writer.write_dense_column(b, columns.back().data());
    }
    error = writer.half_error();
    writer.commit();
  }
  CHECK(error.entry > 0.0);
  CHECK(error.entry <= 0x1p-11);
  const hdf5::File file = hdf5::File::open(path);
  CHECK(file.element_size(kDenseR) == 2);
  CHECK(file.read_double_attribute(kDenseR, "largest_error") == error.entry);
  CHECK(file.read_double_attribute(kDenseR, "compliance_error") == error.compliance);
  // HDF5 itself knows what the numbers are.
  std::vector<double> converted(static_cast<std::size_t>(kSteps * dof));
  file.read_slab<double>(kDenseR, {1, 0, 0}, {1, kSteps, static_cast<hsize_t>(dof)},
                         converted.data());

  const Model read = read_model(path, ResponseKind::kDense);
  const auto& response = std::get<DenseResponse>(read.response);
  const auto& values = std::get<std::vector<Half>>(response.values);
  REQUIRE(response.scales.size() == static_cast<std::size_t>(dof));
  for (int b = 0; b < dof; ++b) {
    const double scale = response.scales[static_cast<std::size_t>(b)];
    for (int a = 0; a < dof; ++a) {
      for (int s = 0; s < kSteps; ++s) {
        const double found =
            scale * to_double(values[static_cast<std::size_t>((b * dof + a) * kSteps + s)]);
        const auto expected = static_cast<double>(columns[static_cast<std::size_t>(b)](s, a));
        REQUIRE(std::abs(found - expected) <= 0x1p-11 * std::abs(expected) + 1e-12);
        if (b == 1) {
          REQUIRE(scale * converted[static_cast<std::size_t>(s * dof + a)] == found);
        }
      }
    }
  }
}

TEST_CASE("dense R of half precision without its scales is refused") {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "model.h5";
  const Model model = test::one_tet_model(2);
  const auto n = static_cast<hsize_t>(model.degrees_of_freedom());
  {
    hdf5::File file = hdf5::File::create(path);
    write_description(file, model);
    const std::vector<Half> numbers(n * 2 * n);
    file.write<Half>(kDenseR, {n, 2, n}, numbers.data());
  }
  CHECK_THROWS_WITH(read_model(path, ResponseKind::kDense), Contains(kDenseScale));
}
