#include <cmath>

#include "replay/reference/broyden_solver.hpp"
#include "tests/support/catch.hpp"

using namespace irdm::replay;

TEST_CASE("Broyden's method finds where a function of several numbers is zero") {
  BroydenSolver solver;
  int calls = 0;
  double shift = 0.0;
  Eigen::VectorXd last;
  const auto function = [&](const Eigen::VectorXd& x) -> Eigen::VectorXd {
    ++calls;
    last = x;
    return Eigen::Vector2d(x(0) * x(0) + x(1) - 3.0 - shift, x(0) - std::exp(x(1) - 1.0) - 0.0);
  };
  Eigen::VectorXd x = Eigen::Vector2d(1.5, 0.5);
  REQUIRE(solver.solve(function, x, 1e-12, 1e-6));
  CHECK(std::abs(x(0) * x(0) + x(1) - 3.0) < 1e-12);
  CHECK(std::abs(x(0) - std::exp(x(1) - 1.0)) < 1e-12);
  CHECK(last == x);
  const int first = calls;
  shift = 1e-4;
  REQUIRE(solver.solve(function, x, 1e-12, 1e-6));
  CHECK(calls - first < first);
  // No zero at all.
  solver.forget();
  x = Eigen::VectorXd::Constant(1, 0.3);
  CHECK_FALSE(solver.solve(
      [](const Eigen::VectorXd& y) -> Eigen::VectorXd { return y.array().square() + 1.0; }, x, 1e-9,
      1e-6));
}
