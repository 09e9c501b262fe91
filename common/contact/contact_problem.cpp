#include "common/contact/contact_problem.hpp"

namespace irdm {
namespace {

using Active = std::array<bool, kMaxContacts>;

// Solves the system of the active contacts; the others have no force.
ContactVector solve_active(const ContactProblem& problem, const Active& active) noexcept {
  std::array<Eigen::Index, kMaxContacts> chosen{};
  Eigen::Index m = 0;
  for (int a = 0; a < problem.count; ++a) {
    if (active[static_cast<std::size_t>(a)]) chosen[static_cast<std::size_t>(m++)] = a;
  }
  ContactMatrix W(3 * m, 3 * m);
  ContactVector gap(3 * m);
  for (Eigen::Index i = 0; i < m; ++i) {
    const Eigen::Index row = 3 * chosen[static_cast<std::size_t>(i)];
    gap.segment<3>(3 * i) = problem.gap.segment<3>(row);
    for (Eigen::Index j = 0; j < m; ++j) {
      W.block<3, 3>(3 * i, 3 * j) =
          problem.W.block<3, 3>(row, 3 * chosen[static_cast<std::size_t>(j)]);
    }
  }
  const ContactVector solved = Eigen::LDLT<ContactMatrix>(W).solve(gap);
  ContactVector force = ContactVector::Zero(3 * problem.count);
  for (Eigen::Index i = 0; i < m; ++i) {
    force.segment<3>(3 * chosen[static_cast<std::size_t>(i)]) = solved.segment<3>(3 * i);
  }
  return force;
}

// The touching contact that pulls hardest, or -1.
int strongest_pull(const ContactProblem& problem, const ContactSolution& solution) noexcept {
  int worst = -1;
  double pull = 0.0;
  for (int a = 0; a < problem.count; ++a) {
    const auto index = static_cast<std::size_t>(a);
    if (!solution.active[index] || problem.law[index] != ContactLaw::kTouching) continue;
    const double outward = solution.force.segment<3>(3 * a).dot(problem.normal[index]);
    if (outward > pull) {
      pull = outward;
      worst = a;
    }
  }
  return worst;
}

double largest_error(const ContactProblem& problem, const ContactSolution& solution) noexcept {
  const ContactVector error = problem.W * solution.force - problem.gap;
  double largest = 0.0;
  for (int a = 0; a < problem.count; ++a) {
    if (solution.active[static_cast<std::size_t>(a)]) {
      largest = std::max(largest, error.segment<3>(3 * a).norm());
    }
  }
  return largest;
}

}  // namespace

ContactSolution solve_contacts(const ContactProblem& problem) noexcept {
  ContactSolution solution;
  for (int a = 0; a < problem.count; ++a) solution.active[static_cast<std::size_t>(a)] = true;
  for (int round = 0; round <= problem.count; ++round) {
    solution.force = solve_active(problem, solution.active);
    const int pulling = strongest_pull(problem, solution);
    if (pulling < 0) break;
    solution.active[static_cast<std::size_t>(pulling)] = false;
  }
  if (!solution.force.allFinite()) {
    solution.force.setZero(3 * problem.count);
    solution.active.fill(false);
    solution.finite = false;
    return solution;
  }
  solution.residual = largest_error(problem, solution);
  return solution;
}

}  // namespace irdm
