#include <cmath>

#include "common/response/modal_response.hpp"
#include "precompute/modal/dense_columns.hpp"
#include "precompute/modal/elastic_statics.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;
using namespace irdm::precompute;

namespace {

constexpr double kDt = 0.002;

ModalResponse some_response() {
  std::srand(1);
  ModalResponse response;
  response.angular_frequency = Eigen::Vector4d(67, 180, 900, 12000);
  response.decay_rate = 0.5 * (8.0 + 2e-4 * response.angular_frequency.array().square());
  response.shapes = RowMatrix<double>(RowMatrix<double>::Random(9, 4));
  return response;
}

}  // namespace

TEST_CASE("a column of R is its modal closed form") {
  const ModalResponse response = some_response();
  const auto& phi = std::get<RowMatrix<double>>(response.shapes);
  const int steps = 40;
  const RowMatrix<double> h = held_responses(response, kDt, steps);
  DenseColumns<double> exact(response, kDt, steps);
  DenseColumns<float> rounded(response, kDt, steps);
  for (int b = 0; b < 9; ++b) {
    const RowMatrix<double>& column = exact.column(b);
    const RowMatrix<double> difference = column - rounded.column(b).cast<double>();
    CHECK(difference.cwiseAbs().maxCoeff() < 1e-6 * column.cwiseAbs().maxCoeff());
    for (int s = 0; s < steps; ++s) {
      for (int a = 0; a < 9; ++a) {
        double sum = 0.0;
        for (int i = 0; i < 4; ++i) sum += phi(a, i) * h(s, i) * phi(b, i);
        REQUIRE(column(s, a) == Approx(sum).epsilon(1e-12).margin(1e-20));
      }
    }
  }
}

TEST_CASE("modes that have died away take no part, and are not missed") {
  const ModalResponse response = some_response();
  const auto& phi = std::get<RowMatrix<double>>(response.shapes);
  const int steps = 400;
  const RowMatrix<double> h = held_responses(response, kDt, steps);
  const DenseColumns<double> columns(response, kDt, steps);
  CHECK(columns.modes_at(0) == 4);
  CHECK(columns.modes_at(steps - 1) < 3);
  const RowMatrix<double> column = columns.column(3);
  for (int s = 0; s < steps; ++s) {
    const Eigen::MatrixXd exact = phi * h.row(s).asDiagonal() * phi.row(3).transpose();
    const double size =
        (phi.cwiseAbs2().colwise().maxCoeff().array() * h.row(s).cwiseAbs().array()).sum();
    CHECK((column.row(s).transpose() - exact).cwiseAbs().maxCoeff() < 1e-15 * size);
  }
}

TEST_CASE("without damping every mode takes part to the end") {
  ModalResponse response = some_response();
  response.decay_rate.setZero();
  CHECK(DenseColumns<float>(response, kDt, 400).modes_at(399) == 4);
}

TEST_CASE("decay left bounds the rest of R and shrinks with the number of steps") {
  const ModalResponse response = some_response();
  const int steps = 300;
  const double bound = decay_left(response, kDt, steps);
  DenseColumns<double> columns(response, kDt, 4 * steps);
  double largest = 0.0;
  for (int a = 0; a < 9; ++a) {
    const Eigen::VectorXd r = columns.column(a).col(a);
    largest =
        std::max(largest, r.tail(3 * steps + 1).cwiseAbs().maxCoeff() / r.cwiseAbs().maxCoeff());
  }
  CHECK(bound >= largest);
  CHECK(bound < 3.0 * largest);
  CHECK(decay_left(response, kDt, 2 * steps) < 0.1 * bound);
}

TEST_CASE("a single mode leaves what its envelope leaves") {
  ModalResponse response;
  response.angular_frequency = Eigen::VectorXd::Constant(1, 67.0);
  response.decay_rate = Eigen::VectorXd::Constant(1, 4.45);
  response.shapes = RowMatrix<double>(RowMatrix<double>::Ones(3, 1));
  CHECK(decay_left(response, kDt, 500) == Approx(std::exp(-4.45)).epsilon(0.2));
}
