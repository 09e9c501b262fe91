#include <thread>

#include "precompute/dynamics/sparse_solver.hpp"
#include "tests/precompute/meshes.hpp"
#include "tests/support/catch.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::precompute;

namespace {

Eigen::SparseMatrix<double> matrix(double h) {
  static const SoftBody body(test::box_mesh(Vector3(0.12, 0.08, 0.10), {3, 3, 2}),
                             {2000.0, 0.49, 110.0, 8.0, 2e-4}, Elasticity::kLinear);
  return step_matrix(body, body.stiffness(body.at_rest().u), h);
}

template <typename Make>
void check_solver(const Make& make) {
  const auto solver = make();
  std::srand(1);
  for (const double h : {1e-3, 1e-4}) {  // the same pattern
    const Eigen::SparseMatrix<double> a = matrix(h);
    solver->factorise(a);
    const Eigen::MatrixXd x = Eigen::MatrixXd::Random(a.rows(), 5);
    const Eigen::MatrixXd b = a * x;
    CHECK((solver->solve(b) - x).norm() < 1e-10 * x.norm());
    const Eigen::VectorXd single = solver->solve(b.col(2));
    CHECK((single - x.col(2)).norm() < 1e-10 * x.norm());
  }
  Eigen::SparseMatrix<double> negative = matrix(1e-3);
  negative.coeffRef(4, 4) = -1.0;
  CHECK_THROWS_WITH(solver->factorise(negative), ContainsSubstring("not positive definite"));
}

}  // namespace

TEST_CASE("sparse solver solves for many right-hand sides and refuses an indefinite matrix") {
  SECTION("the default") {
    check_solver(make_sparse_solver);
  }
  SECTION("Eigen's") {
    check_solver(make_eigen_solver);
  }
}

TEST_CASE("several threads solve with one factorisation") {
  const Eigen::SparseMatrix<double> a = matrix(1e-3);
  const auto solver = make_sparse_solver();
  solver->factorise(a);
  std::srand(1);
  const Eigen::MatrixXd b = Eigen::MatrixXd::Random(a.rows(), 4);
  const Eigen::MatrixXd expected = solver->solve(b);
  std::vector<Eigen::MatrixXd> solved(4);
  {
    std::vector<std::jthread> threads;
    for (Eigen::MatrixXd& mine : solved) {
      threads.emplace_back([&] {
        for (int k = 0; k < 50; ++k) mine = solver->solve(b);
      });
    }
  }
  for (const Eigen::MatrixXd& mine : solved) CHECK(mine == expected);
}
