#include <limits>
#include <random>
#include <vector>

#include "common/contact/contact_problem.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;

namespace {

// Contacts on a body whose elastic answers are weakly coupled, as those of distant points are.
ContactProblem random_problem(int count, unsigned seed) {
  std::srand(seed);  // Eigen::Random
  ContactProblem problem(std::max(count, 1));
  problem.begin(count);
  const Eigen::MatrixXd a = Eigen::MatrixXd::Random(3 * count, 3 * count);
  const Eigen::MatrixXd W =
      1e-3 * (0.2 * a * a.transpose() + Eigen::MatrixXd::Identity(3 * count, 3 * count));
  problem.rigid = {2e-5, 1e-3 * Matrix3::Identity()};
  for (int i = 0; i < count; ++i) {
    for (int j = 0; j < count; ++j) problem.elastic(i, j) = W.block<3, 3>(3 * i, 3 * j);
    problem.contact(i).gap = 1e-3 * Vector3::Random();
    problem.contact(i).arm = 0.06 * Vector3::Random();
    problem.contact(i).normal = Vector3::Random().normalized();
  }
  return problem;
}

Vector3 moved(const ContactProblem& problem, int a) {
  Vector3 sum = Vector3::Zero();
  for (int b = 0; b < problem.count(); ++b) {
    sum += problem.compliance(a, b) * problem.contact(b).force;
  }
  return sum;
}

double strongest_force(const ContactProblem& problem) {
  double largest = 0.0;
  for (int a = 0; a < problem.count(); ++a) {
    largest = std::max(largest, problem.contact(a).force.norm());
  }
  return largest;
}

ContactSolution solve(ContactProblem& problem) {
  return ContactSolver(problem.capacity()).solve(problem);
}

// Coulomb's law, stated without the solver: how far a touching contact is from fulfilling it [m].
double violation(const ContactProblem& problem, int a) {
  const ContactConstraint& contact = problem.contact(a);
  const Vector3 open = contact.gap - moved(problem, a);
  const double push = -contact.force.dot(contact.normal);
  const Vector3 along = contact.force + push * contact.normal;
  const double size = problem.compliance(a, a).trace();
  double worst = std::max(0.0, -push) * size;          // never pulls
  worst = std::max(worst, -open.dot(contact.normal));  // never left inside
  if (push > 0) worst = std::max(worst, std::abs(open.dot(contact.normal)));
  if (contact.mode == ContactMode::kSticking) {
    worst = std::max(worst, open.norm());
    worst = std::max(worst, (along.norm() - contact.friction.static_ * push) * size);
  }
  if (contact.mode == ContactMode::kSlipping) {
    const Vector3 slip = open - open.dot(contact.normal) * contact.normal;
    worst = std::max(worst, std::abs(along.norm() - contact.friction.kinetic * push) * size);
    worst = std::max(worst, along.norm() > 0
                                ? (slip - slip.dot(along) * along / along.squaredNorm()).norm()
                                : 0.0);
    if (slip.dot(along) < 0) worst = std::max(worst, slip.norm());
    worst = std::max(worst, (slip - contact.slip).norm());
  }
  return worst;
}

}  // namespace

TEST_CASE("held contacts take their points where they are wanted") {
  for (int count = 1; count <= kMaxContacts; ++count) {
    ContactProblem problem = random_problem(count, static_cast<unsigned>(count));
    const ContactSolution solution = solve(problem);
    for (int a = 0; a < count; ++a) {
      CHECK((moved(problem, a) - problem.contact(a).gap).norm() < 1e-15);
    }
    CHECK(solution.residual < 1e-14);
    CHECK(solution.sweeps == 0);
  }
}

TEST_CASE("a touching contact pushes with what closes its gap") {
  ContactProblem problem = random_problem(1, 3);
  problem.contact(0).law = ContactLaw::kTouching;
  problem.contact(0).normal = Vector3::UnitZ();
  problem.contact(0).gap = problem.compliance(0, 0) * Vector3(0.1, 0.2, -1.0);
  solve(problem);
  CHECK(problem.contact(0).mode == ContactMode::kSticking);
  CHECK((problem.contact(0).force - Vector3(0.1, 0.2, -1.0)).norm() < 1e-12);
}

TEST_CASE("a touching contact lets go rather than pull") {
  ContactProblem problem = random_problem(1, 3);
  problem.contact(0).law = ContactLaw::kTouching;
  problem.contact(0).normal = Vector3::UnitZ();
  problem.contact(0).gap = problem.compliance(0, 0) * Vector3(0.1, 0.2, 1.0);
  solve(problem);
  CHECK(problem.contact(0).mode == ContactMode::kOpen);
  CHECK(problem.contact(0).force.norm() == 0.0);
}

TEST_CASE("a given force acts as it is, and the others know of it") {
  ContactProblem problem = random_problem(3, 5);
  problem.contact(1).law = ContactLaw::kGiven;
  problem.contact(1).force = Vector3(0.3, -0.2, 0.1);
  solve(problem);
  CHECK(problem.contact(1).force == Vector3(0.3, -0.2, 0.1));
  CHECK((moved(problem, 0) - problem.contact(0).gap).norm() < 1e-15);
  CHECK((moved(problem, 2) - problem.contact(2).gap).norm() < 1e-15);
}

TEST_CASE("a released contact has no force") {
  ContactProblem problem = random_problem(2, 6);
  problem.contact(0).law = ContactLaw::kReleased;
  solve(problem);
  CHECK(problem.contact(0).mode == ContactMode::kOpen);
  CHECK(problem.contact(0).force.norm() == 0.0);
  CHECK((moved(problem, 1) - problem.contact(1).gap).norm() < 1e-15);
}

TEST_CASE("one contact: at the limit of static friction it sticks, beyond it slips on the cone") {
  const Vector3 n = Vector3::UnitZ();
  const Matrix3 W = 1e-3 * Matrix3::Identity();  // isotropic: the answer is known
  const Friction friction{0.5, 0.4};
  const auto at = [&](double along) {
    return solve_single_contact(W, W * Vector3(along, 0, -1.0), ContactLaw::kTouching, n, friction);
  };
  CHECK(at(0.499).mode == ContactMode::kSticking);
  const SingleContact slipping = at(0.501);
  CHECK(slipping.mode == ContactMode::kSlipping);
  CHECK((slipping.force - Vector3(0.4, 0, -1.0)).norm() < 1e-12);
  CHECK((slipping.slip - Vector3(0.101e-3, 0, 0)).norm() < 1e-15);
}

// A compliance by which a force along x moves the point across the surface, too: slipping towards
// +x with friction 1 the point yields by 1 - coupling of what it does without friction.
TEST_CASE("one contact: where friction would hold without end it pushes 20 times as without") {
  const Vector3 n = Vector3::UnitZ();
  const auto slipping = [&](double coupling, double along) {
    Matrix3 W = 1e-3 * Matrix3::Identity();
    W(0, 2) = W(2, 0) = 1e-3 * coupling;
    const Vector3 gap = W * Vector3(along, 0, -1.0);
    const SingleContact found =
        solve_single_contact(W, gap, ContactLaw::kTouching, n, Friction{1.0, 1.0});
    REQUIRE(found.mode == ContactMode::kSlipping);
    REQUIRE(found.slip.x() > 0.0);
    const double frictionless = -gap.z() / W(2, 2);
    return -found.force.z() / frictionless;
  };
  CHECK(slipping(0.94, 1.05) == Approx(1.0 / 0.06));  // the law is met
  CHECK(slipping(0.98, 1.01) == Approx(20.0));
}

TEST_CASE("one contact meets Coulomb's law for any compliance, gap and friction") {
  std::mt19937 random(17);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  int sticking = 0;
  int slipping = 0;
  int open = 0;
  for (unsigned seed = 0; seed < 5000; ++seed) {
    ContactProblem problem = random_problem(1, seed);
    ContactConstraint& contact = problem.contact(0);
    contact.law = ContactLaw::kTouching;
    const double mu = 1.2 * uniform(random);
    contact.friction = {mu, mu};
    solve(problem);
    sticking += contact.mode == ContactMode::kSticking ? 1 : 0;
    slipping += contact.mode == ContactMode::kSlipping ? 1 : 0;
    open += contact.mode == ContactMode::kOpen ? 1 : 0;
    INFO("seed " << seed << ", mu " << mu << ", mode " << static_cast<int>(contact.mode));
    REQUIRE(violation(problem, 0) < 1e-12);
  }
  CHECK(sticking > 300);
  CHECK(slipping > 500);
  CHECK(open > 500);
}

TEST_CASE("many contacts together meet Coulomb's law, and no friction force gives energy") {
  for (unsigned seed = 0; seed < 400; ++seed) {
    ContactProblem problem = random_problem(2 + static_cast<int>(seed % 20), seed);
    for (int a = 0; a < problem.count(); ++a) {
      if ((seed + static_cast<unsigned>(a)) % 3 != 0)
        problem.contact(a).law = ContactLaw::kTouching;
      problem.contact(a).friction = {0.5, 0.5};
    }
    const ContactSolution solution = solve(problem);
    REQUIRE(solution.solved);
    for (int a = 0; a < problem.count(); ++a) {
      const ContactConstraint& contact = problem.contact(a);
      INFO("seed " << seed << ", contact " << a << " of " << problem.count() << ", sweeps "
                   << solution.sweeps);
      if (contact.law == ContactLaw::kHeld) {
        REQUIRE((moved(problem, a) - contact.gap).norm() < 1e-10);
      } else {
        REQUIRE(violation(problem, a) < 1e-10);
        REQUIRE(contact.force.dot(contact.slip) >= 0.0);
      }
    }
  }
}

// Between kinetic and static friction: what does not slip yet has not to slide first.
TEST_CASE("contacts that stick only by static friction are solved directly") {
  for (unsigned seed = 0; seed < 20; ++seed) {
    ContactProblem problem = random_problem(4, seed);
    std::vector<Vector3> forces;
    for (int a = 0; a < problem.count(); ++a) {
      ContactConstraint& contact = problem.contact(a);
      contact.law = ContactLaw::kTouching;
      contact.friction = {0.5, 0.4};
      contact.force = 0.45 * contact.normal.unitOrthogonal() - contact.normal;
      forces.push_back(contact.force);
    }
    for (int a = 0; a < problem.count(); ++a) problem.contact(a).gap = moved(problem, a);
    for (int a = 0; a < problem.count(); ++a) problem.contact(a).force.setZero();
    const ContactSolution solution = solve(problem);
    CHECK(solution.sweeps == 0);
    for (int a = 0; a < problem.count(); ++a) {
      CHECK(problem.contact(a).mode == ContactMode::kSticking);
      CHECK((problem.contact(a).force - forces[static_cast<std::size_t>(a)]).norm() < 1e-10);
    }
  }
}

// Held contacts answer each change of another at once: what is left for the sweeps is the ridge.
TEST_CASE("one contact that slips beside held ones is solved within three sweeps") {
  int slipping = 0;
  for (unsigned seed = 0; seed < 100; ++seed) {
    ContactProblem problem = random_problem(3, seed);
    problem.contact(2).law = ContactLaw::kTouching;
    problem.contact(2).friction = {0.2, 0.2};
    const ContactSolution solution = solve(problem);
    if (problem.contact(2).mode != ContactMode::kSlipping) continue;
    ++slipping;
    CHECK(solution.sweeps <= 3);
    CHECK(violation(problem, 2) < 1e-12);
    for (int a = 0; a < 2; ++a) {
      CHECK((moved(problem, a) - problem.contact(a).gap).norm() < 1e-12);
    }
  }
  CHECK(slipping > 10);
}

TEST_CASE("the iteration starts from the forces that it is given") {
  ContactProblem problem = random_problem(20, 8);
  for (int a = 0; a < problem.count(); ++a) {
    problem.contact(a).law = ContactLaw::kTouching;
    problem.contact(a).friction = {0.3, 0.3};
  }
  const int cold = solve(problem).sweeps;
  const int warm = solve(problem).sweeps;
  CHECK(cold > 2);
  CHECK(warm <= 2);
}

TEST_CASE("a problem that cannot be solved gives no force and says so") {
  ContactProblem problem = random_problem(2, 9);
  problem.contact(1).gap[1] = std::numeric_limits<double>::quiet_NaN();
  const ContactSolution solution = solve(problem);
  CHECK_FALSE(solution.solved);
  CHECK(problem.contact(0).force.norm() == 0.0);
  CHECK(problem.contact(1).force.norm() == 0.0);
}

TEST_CASE("an iteration that ends above the worst residual is no solution, and gives no force") {
  const auto touching = [] {
    ContactProblem problem = random_problem(20, 8);
    for (int a = 0; a < problem.count(); ++a) {
      problem.contact(a).law = ContactLaw::kTouching;
      problem.contact(a).friction = {0.3, 0.3};
    }
    return problem;
  };
  SolverLimits limits;
  limits.max_sweeps = 1;
  limits.worst = 1e-2;
  ContactProblem problem = touching();
  const ContactSolution one = ContactSolver(problem.capacity()).solve(problem, limits);
  CHECK(one.solved);
  CHECK(strongest_force(problem) > 0.1);
  CHECK(one.residual > 1e-3);

  ContactProblem same = touching();
  limits.worst = 1e-3;
  const ContactSolution unsolved = ContactSolver(same.capacity()).solve(same, limits);
  CHECK_FALSE(unsolved.solved);
  CHECK(unsolved.sweeps == 1);
  CHECK(unsolved.residual == one.residual);
  CHECK(strongest_force(same) == 0.0);
  for (int a = 0; a < same.count(); ++a) {
    CHECK(same.contact(a).mode == ContactMode::kOpen);
  }
}

// Of all forces across `pressed` of at most its length times mu, the one that leaves the least
// energy f W f / 2 - f gap: the principle of maximum dissipation, searched on a grid of the disk.
TEST_CASE("friction of a group: no other force in its disk leaves less energy") {
  std::srand(5);
  for (int i = 0; i < 40; ++i) {
    const Matrix3 a = Matrix3::Random();
    const Matrix3 W = 1e-3 * (a * a.transpose() + 0.1 * Matrix3::Identity());
    const Vector3 gap = 2e-3 * Vector3::Random();
    const Vector3 pressed = Vector3::Random();
    const Friction friction{0.5, 0.5};
    const auto energy = [&](const Vector3& f) { return 0.5 * f.dot(W * f) - f.dot(gap); };
    const SingleContact found = solve_group_friction(W, gap, pressed, friction);
    const double most = 0.5 * pressed.norm();
    CHECK(std::abs(found.force.dot(pressed)) < 1e-12);
    CHECK(found.force.norm() <= most * (1.0 + 1e-12));
    CHECK((found.mode == ContactMode::kSlipping) == (found.force.norm() > most * (1.0 - 1e-12)));
    const Vector3 one = pressed.unitOrthogonal();
    const Vector3 other = pressed.normalized().cross(one);
    double least = 0.0;
    for (int r = 1; r <= 20; ++r) {
      for (int k = 0; k < 360; ++k) {
        const double angle = 2.0 * std::acos(-1.0) * k / 360;
        least = std::min(least,
                         energy(most * r / 20 * (std::cos(angle) * one + std::sin(angle) * other)));
      }
    }
    CHECK(energy(found.force) <= least + 1e-12);
    const Vector3 open = gap - W * found.force;
    const Vector3 along = open - open.dot(pressed) * pressed / pressed.squaredNorm();
    CHECK((found.slip - along).norm() < 1e-12);
  }
  CHECK(solve_group_friction(Matrix3::Identity(), Vector3::UnitX(), Vector3::Zero(), {0.5, 0.5})
            .mode == ContactMode::kOpen);
}

TEST_CASE(
    "contacts that share their friction: each closes its gap, and the friction is Coulomb's") {
  int slipping = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    const int count = 3 + static_cast<int>(seed % 10);
    ContactProblem problem = random_problem(count + 1, seed);
    problem.rigid = {};
    const Vector3 up = Vector3::UnitY();
    for (int i = 0; i < count; ++i) {
      ContactConstraint& contact = problem.contact(i);
      contact.law = ContactLaw::kTouching;
      contact.normal = (up + 0.4 * Vector3::Random()).normalized();
      contact.friction = {0.0, 0.0};
      contact.gap -= 1e-3 * up;
    }
    ContactConstraint& friction = problem.contact(count);
    friction.law = ContactLaw::kGroupFriction;
    friction.friction = {0.5, 0.4};
    friction.gap *= 3.0;
    friction.group_first = 0;
    friction.group_count = count;
    const ContactSolution solution = solve(problem);
    REQUIRE(solution.solved);
    CHECK(solution.residual < 1e-12);
    Vector3 pressed = Vector3::Zero();
    for (int i = 0; i < count; ++i) {
      pressed += problem.contact(i).force;
      const ContactConstraint& contact = problem.contact(i);
      const double open = (contact.gap - moved(problem, i)).dot(contact.normal);
      const double pull = contact.force.dot(contact.normal);
      CHECK(contact.force.cross(contact.normal).norm() < 1e-12);
      CHECK(pull <= 0.0);
      CHECK(open > -1e-10);
      CHECK(pull * open > -1e-10);
    }
    const double push = pressed.norm();
    const Vector3 open = friction.gap - moved(problem, count);
    const Vector3 along = open - open.dot(pressed) * pressed / (push * push);
    CHECK(std::abs(friction.force.dot(pressed)) < 1e-8 * push);
    if (friction.mode == ContactMode::kSticking) {
      CHECK(along.norm() < 1e-10);
      CHECK(friction.force.norm() <= 0.5 * push);
    } else {
      ++slipping;
      CHECK(friction.force.norm() == Approx(0.4 * push));
      CHECK(along.cross(friction.force).norm() < 1e-10 * friction.force.norm());
      CHECK(along.dot(friction.force) > 0.0);
    }
  }
  CHECK(slipping > 5);
  CHECK(slipping < 35);
}

// Three contacts of a thin part that bends: a force along the surface presses or lifts them by more
// than they yield themselves.
TEST_CASE("friction of a group finds a solution where it moves the contacts across the surface") {
  const double angle = GENERATE(0.0, 0.5, 0.8, 1.05);
  const double mu = GENERATE(0.3, 0.5, 0.8);
  const double side = GENERATE(1.0, -1.0);
  ContactProblem problem(4);
  problem.begin(4);
  problem.clear_elastic();
  const Vector3 bends(std::sin(angle), std::cos(angle), 0.0);
  const Matrix3 shared = 1e-2 * bends * bends.transpose();
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 3; ++b) {
      problem.elastic(a, b) = shared;
      if (a == b) problem.elastic(a, b) += 2e-4 * Matrix3::Identity();
    }
    ContactConstraint& contact = problem.contact(a);
    contact.law = ContactLaw::kTouching;
    contact.normal = Vector3::UnitY();
    contact.friction = {0.0, 0.0};
    contact.gap = Vector3(side * 5e-3, -1e-3 * (1.0 + 0.1 * a), 0.0);
  }
  for (int b = 0; b < 3; ++b) {
    const Matrix3 mean =
        (problem.elastic(0, b) + problem.elastic(1, b) + problem.elastic(2, b)) / 3.0;
    problem.elastic(3, b) = mean;
    problem.elastic(b, 3) = mean.transpose();
  }
  problem.elastic(3, 3) =
      (problem.elastic(0, 3) + problem.elastic(1, 3) + problem.elastic(2, 3)) / 3.0;
  ContactConstraint& friction = problem.contact(3);
  friction.law = ContactLaw::kGroupFriction;
  friction.friction = {mu, mu};
  friction.group_count = 3;
  friction.gap = problem.contact(1).gap;
  const ContactSolution solution = ContactSolver(4).solve(problem, {200, 1e-8, 60, 1e-7, 1e-4, 0});
  INFO("angle " << angle << ", mu " << mu << ", side " << side << ": " << solution.sweeps
                << " sweeps, residual " << solution.residual);
  CHECK(solution.solved);
  CHECK(solution.residual < 1e-7);
}

TEST_CASE("a gap that is no number is no solution, without friction too") {
  ContactProblem problem = random_problem(12, 3);
  for (int a = 0; a < 12; ++a) {
    problem.contact(a).law = ContactLaw::kTouching;
    problem.contact(a).friction = {0.0, 0.0};
  }
  problem.contact(4).gap.x() = std::numeric_limits<double>::quiet_NaN();
  CHECK_FALSE(solve(problem).solved);
}

TEST_CASE("no contacts, no forces") {
  ContactProblem problem = random_problem(0, 1);
  const ContactSolution solution = solve(problem);
  CHECK(solution.solved);
  CHECK(solution.sweeps == 0);
}
