#include <catch2/catch.hpp>
#include <limits>
#include <random>

#include "common/contact/contact_problem.hpp"

using namespace irdm;

namespace {

ContactProblem random_problem(int count, unsigned seed) {
  std::srand(seed);  // Eigen::Random
  ContactProblem problem;
  problem.count = count;
  const Eigen::MatrixXd a = Eigen::MatrixXd::Random(3 * count, 3 * count);
  problem.W = 1e-3 * (a * a.transpose() + Eigen::MatrixXd::Identity(3 * count, 3 * count));
  problem.gap = 1e-3 * Eigen::VectorXd::Random(3 * count);
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    problem.law[i] = ContactLaw::kHeld;
    problem.normal[i] = Vector3::Random().normalized();
  }
  return problem;
}

}  // namespace

TEST_CASE("held contacts take their points where they are wanted") {
  for (int count = 1; count <= kMaxContacts; ++count) {
    const ContactProblem problem = random_problem(count, static_cast<unsigned>(count));
    const ContactSolution solution = solve_contacts(problem);
    CHECK((problem.W * solution.force - problem.gap).norm() < 1e-12 * problem.gap.norm());
    CHECK(solution.residual < 1e-14);
  }
}

TEST_CASE("a touching contact pushes with what closes its gap") {
  ContactProblem problem = random_problem(1, 3);
  problem.law[0] = ContactLaw::kTouching;
  problem.normal[0] = Vector3::UnitZ();
  problem.gap = problem.W * Vector3(0.1, 0.2, -1.0);
  const ContactSolution solution = solve_contacts(problem);
  CHECK(solution.active[0]);
  CHECK((solution.force - Vector3(0.1, 0.2, -1.0)).norm() < 1e-12);
}

TEST_CASE("a touching contact lets go rather than pull") {
  ContactProblem problem = random_problem(1, 3);
  problem.law[0] = ContactLaw::kTouching;
  problem.normal[0] = Vector3::UnitZ();
  problem.gap = problem.W * Vector3(0.1, 0.2, 1.0);
  const ContactSolution solution = solve_contacts(problem);
  CHECK_FALSE(solution.active[0]);
  CHECK(solution.force.norm() == 0.0);
}

TEST_CASE("no touching contact ever pulls, and those that stay close their gaps") {
  for (unsigned seed = 0; seed < 200; ++seed) {
    ContactProblem problem = random_problem(1 + static_cast<int>(seed % kMaxContacts), seed);
    for (std::size_t i = 0; i < kMaxContacts; ++i) {
      if ((seed + i) % 3 != 0) problem.law[i] = ContactLaw::kTouching;
    }
    const ContactSolution solution = solve_contacts(problem);
    for (int a = 0; a < problem.count; ++a) {
      const auto index = static_cast<std::size_t>(a);
      const Vector3 force = solution.force.segment<3>(3 * a);
      if (problem.law[index] == ContactLaw::kTouching) {
        REQUIRE(force.dot(problem.normal[index]) <= 0.0);
      }
      if (!solution.active[index]) REQUIRE(force.norm() == 0.0);
    }
    REQUIRE(solution.residual < 1e-12);
  }
}

TEST_CASE("a problem that cannot be solved gives no force and says so") {
  ContactProblem problem = random_problem(2, 9);
  problem.gap[4] = std::numeric_limits<double>::quiet_NaN();
  const ContactSolution solution = solve_contacts(problem);
  CHECK_FALSE(solution.finite);
  CHECK(solution.force.norm() == 0.0);
}

TEST_CASE("no contacts, no forces") {
  const ContactProblem problem = random_problem(0, 1);
  CHECK(solve_contacts(problem).force.size() == 0);
}
