#include "common/contact/contact_problem.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace irdm {
namespace {

// Largest number of directions that slip() tries. It converges in about six, unless W is nearly
// singular.
constexpr int kMaxTurns = 60;
// Change of the direction at which it has converged [rad].
constexpr double kConverged = 1e-15;
// Range of the slope of the remaining turn over the angle in which the secant method is safe: the
// fixed point of the turns is attractive there.
constexpr double kSteepest = -1.95;
constexpr double kFlattest = -1e-3;
// Largest step of the secant method [rad].
constexpr double kMaxStep = 0.5;

Vector3 sideways(const Vector3& v, const Vector3& normal) noexcept {
  return v - v.dot(normal) * normal;
}

// Force on the cone for a direction d along the surface: f = N (mu d - n), with N from the normal
// part of W f = gap. Where friction would hold the point without end (W_nn <= mu W_nd), N is that
// without friction.
Vector3 force_towards(const Matrix3& W, const Vector3& gap, const Vector3& normal, double mu,
                      const Vector3& d) noexcept {
  const Vector3 on_cone = mu * d - normal;
  const double yielding = -normal.dot(W * on_cone);
  const double frictionless = normal.dot(W * normal);
  const double push = -normal.dot(gap) / std::max(yielding, 0.05 * frictionless);
  return push * on_cone;
}

// Without friction.
SingleContact slip_freely(const Matrix3& W, const Vector3& gap, const Vector3& normal) noexcept {
  SingleContact result;
  result.mode = ContactMode::kSlipping;
  result.force = force_towards(W, gap, normal, 0.0, Vector3::Zero());
  result.slip = sideways(gap - W * result.force, normal);
  return result;
}

struct BoundedForce {
  Eigen::Vector2d force;
  double lag;  ///< what of the gap stays open, over the force [m/N]
};

// Solves (A + lag Id) f = gap for the lag >= 0 with which |f| = most, which is less than
// |A^-1 gap|. Newton's method on 1 / |f|, which is concave in the lag, comes from below and never
// goes too far.
BoundedForce bounded_force(const Eigen::Matrix2d& A, const Eigen::Vector2d& gap,
                           double most) noexcept {
  BoundedForce result{Eigen::Vector2d::Zero(), 0.0};
  for (int i = 0; i < kMaxTurns; ++i) {
    const Eigen::Matrix2d inverse = (A + result.lag * Eigen::Matrix2d::Identity()).inverse();
    result.force = inverse * gap;
    const double length = result.force.norm();
    if (length <= (1.0 + kConverged) * most) break;
    const double slope = result.force.dot(inverse * result.force) / (length * length);
    result.lag += (length / most - 1.0) / slope;
  }
  return result;
}

// Finds the direction d along the surface that is parallel to the slip it leaves. Turning d towards
// the slip is a contraction; the secant method finds its fixed point in few steps.
SingleContact slip(const Matrix3& W, const Vector3& gap, const Vector3& normal, double mu,
                   const Vector3& stick) noexcept {
  SingleContact result;
  result.mode = ContactMode::kSlipping;
  const Vector3 first = sideways(stick, normal).normalized();
  const Vector3 across = normal.cross(first);
  const double scale = W.trace();
  double angle = 0.0;
  double last_angle = 0.0;
  double last_turn = 0.0;
  for (int i = 0; i < kMaxTurns; ++i) {
    const Vector3 d = std::cos(angle) * first + std::sin(angle) * across;
    result.force = force_towards(W, gap, normal, mu, d);
    result.slip = sideways(gap - W * result.force, normal);
    const double hold = scale * sideways(result.force, normal).norm();
    const double turn = std::atan2(normal.cross(d).dot(result.slip), hold + d.dot(result.slip));
    if (!(std::abs(turn) > kConverged)) break;
    double step = turn;
    if (i > 0) {
      const double slope = (turn - last_turn) / (angle - last_angle);
      if (slope > kSteepest && slope < kFlattest) {
        step = std::clamp(-turn / slope, -kMaxStep, kMaxStep);
      }
    }
    last_turn = turn;
    last_angle = angle;
    angle += step;
    if (angle == last_angle) break;
  }
  return result;
}

}  // namespace

SingleContact solve_single_contact(const Matrix3& W, const Vector3& gap, ContactLaw law,
                                   const Vector3& normal, const Friction& friction) noexcept {
  if (law == ContactLaw::kReleased) return {};
  if (law == ContactLaw::kTouching && gap.dot(normal) >= 0) return {};
  const Vector3 stick = W.ldlt().solve(gap);
  if (law == ContactLaw::kHeld) return {stick, ContactMode::kSticking, Vector3::Zero()};
  const double push = -stick.dot(normal);
  const double along = sideways(stick, normal).norm();
  if (push >= 0 && (std::isinf(friction.static_) || along <= friction.static_ * push)) {
    return {stick, ContactMode::kSticking, Vector3::Zero()};
  }
  if (std::isinf(friction.kinetic)) return {};  // would have to be pulled, and cannot slip
  if (friction.kinetic == 0.0 || along == 0.0) return slip_freely(W, gap, normal);
  return slip(W, gap, normal, friction.kinetic, stick);
}

SingleContact solve_group_friction(const Matrix3& W, const Vector3& gap, const Vector3& pressed,
                                   const Friction& friction) noexcept {
  const double push = pressed.norm();
  if (!(push > 0.0)) return {};
  const Vector3 normal = pressed / push;
  Eigen::Matrix<double, 3, 2> plane;
  plane.col(0) = normal.unitOrthogonal();
  plane.col(1) = normal.cross(plane.col(0));
  const Eigen::Matrix2d within = plane.transpose() * W * plane;
  const Eigen::Vector2d open = plane.transpose() * gap;
  const Eigen::Vector2d stick = within.inverse() * open;
  if (stick.norm() <= friction.static_ * push) {
    return {plane * stick, ContactMode::kSticking, Vector3::Zero()};
  }
  const double most = friction.kinetic * push;
  if (most == 0.0) return {Vector3::Zero(), ContactMode::kSlipping, plane * open};
  const BoundedForce found = bounded_force(within, open, most);
  return {plane * found.force, ContactMode::kSlipping, plane * (found.lag * found.force)};
}

namespace {

using DirectMatrix = ContactMatrix;
using DirectVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3 * kMaxContacts, 1>;
using Active = std::array<bool, kMaxContacts>;

// What is added to the compliance of contacts that are held together, as a share of its mean.
constexpr double kHeldRidge = 1e-9;

// Displacement of a contact's point by all forces.
Vector3 moved(const ContactProblem& problem, int a) noexcept {
  Vector3 sum = Vector3::Zero();
  for (int b = 0; b < problem.count(); ++b) {
    sum += problem.compliance(a, b) * problem.contact(b).force;
  }
  return sum;
}

bool given(const ContactProblem& problem, int a) noexcept {
  return problem.contact(a).law == ContactLaw::kGiven;
}

// Forces with which all active contacts stick; the others have none, but those that are given.
void stick_active(ContactProblem& problem, const Active& active) noexcept {
  std::array<int, kMaxContacts> chosen{};
  int m = 0;
  for (int a = 0; a < problem.count(); ++a) {
    if (given(problem, a)) continue;
    problem.contact(a).force.setZero();
    if (active[static_cast<std::size_t>(a)]) chosen[static_cast<std::size_t>(m++)] = a;
  }
  DirectMatrix W(3 * m, 3 * m);
  DirectVector gap(3 * m);
  for (int i = 0; i < m; ++i) {
    const int a = chosen[static_cast<std::size_t>(i)];
    gap.segment<3>(3 * i) = problem.contact(a).gap - moved(problem, a);
    for (int j = 0; j < m; ++j) {
      W.block<3, 3>(3 * i, 3 * j) = problem.compliance(a, chosen[static_cast<std::size_t>(j)]);
    }
  }
  const DirectVector force = Eigen::LDLT<DirectMatrix>(W).solve(gap);
  for (int i = 0; i < m; ++i) {
    problem.contact(chosen[static_cast<std::size_t>(i)]).force = force.segment<3>(3 * i);
  }
}

// The touching contact that pulls hardest, or -1.
int strongest_pull(const ContactProblem& problem, const Active& active) noexcept {
  int worst = -1;
  double pull = 0.0;
  for (int a = 0; a < problem.count(); ++a) {
    const ContactConstraint& contact = problem.contact(a);
    if (!active[static_cast<std::size_t>(a)] || contact.law != ContactLaw::kTouching) continue;
    const double outward = contact.force.dot(contact.normal);
    if (outward > pull) {
      pull = outward;
      worst = a;
    }
  }
  return worst;
}

bool inside_cone(const ContactConstraint& contact) noexcept {
  if (contact.law != ContactLaw::kTouching || std::isinf(contact.friction.static_)) return true;
  const double push = -contact.force.dot(contact.normal);
  const Vector3 along = contact.force + push * contact.normal;
  return along.norm() <= contact.friction.static_ * push;
}

void give_up(ContactProblem& problem) noexcept {
  for (int a = 0; a < problem.count(); ++a) {
    problem.contact(a).force.setZero();
    problem.contact(a).slip.setZero();
    problem.contact(a).mode = ContactMode::kOpen;
  }
}

double largest_error(const ContactProblem& problem) noexcept {
  double largest = 0.0;
  for (int a = 0; a < problem.count(); ++a) {
    const ContactConstraint& contact = problem.contact(a);
    if (contact.law == ContactLaw::kGiven || contact.mode != ContactMode::kSticking) continue;
    largest = std::max(largest, (contact.gap - moved(problem, a)).norm());
  }
  return largest;
}

bool finite(const ContactProblem& problem) noexcept {
  for (int a = 0; a < problem.count(); ++a) {
    if (!problem.contact(a).force.allFinite()) return false;
  }
  return true;
}

}  // namespace

ContactProblem::ContactProblem(int capacity)
    : elastic_(Eigen::MatrixXd::Zero(3 * capacity, 3 * capacity)),
      contacts_(static_cast<std::size_t>(capacity)) {}

void ContactProblem::begin(int count) noexcept {
  count_ = count;
  std::fill_n(contacts_.begin(), count, ContactConstraint{});
}

ContactSolver::ContactSolver(int capacity)
    : now_(Eigen::VectorXd::Zero(6 + 6 * capacity)),
      before_(now_),
      direction_(now_),
      own_(static_cast<std::size_t>(capacity)),
      across_(static_cast<std::size_t>(capacity)),
      held_answer_(Eigen::MatrixXd::Zero(3 * kMaxContacts, 3 * capacity)) {}

namespace {

// From then on the friction of a group that slips takes half of each change.
constexpr int kUndampedSweeps = 20;

bool is_smooth(const ContactConstraint& contact) noexcept {
  return contact.law == ContactLaw::kTouching && contact.friction.static_ == 0.0;
}

// Few, or such that none can let go: one factorisation is enough.
bool may_stick(const ContactProblem& problem) noexcept {
  for (int a = 0; a < problem.count(); ++a) {
    if (problem.contact(a).law == ContactLaw::kGroupFriction) return false;
  }
  if (problem.count() <= kMaxDirectContacts) return true;
  if (problem.count() > kMaxContacts) return false;
  for (int a = 0; a < problem.count(); ++a) {
    if (problem.contact(a).law == ContactLaw::kTouching) return false;
  }
  return true;
}

}  // namespace

ContactSolution ContactSolver::solve(ContactProblem& problem, const SolverLimits& limits) noexcept {
  ContactSolution solution;
  if (problem.count() == 0) return solution;
  if (may_stick(problem) && stick(problem)) {
    solution.residual = largest_error(problem);
  } else {
    solution = iterate(problem, limits);
  }
  if (solution.solved && finite(problem)) return solution;
  give_up(problem);
  solution.solved = false;
  return solution;
}

// True when forces without slip are the solution. Otherwise the forces that were given are kept.
bool ContactSolver::stick(ContactProblem& problem) noexcept {
  std::array<Vector3, kMaxContacts> start;
  Active active{};
  for (int a = 0; a < problem.count(); ++a) {
    start[static_cast<std::size_t>(a)] = problem.contact(a).force;
    active[static_cast<std::size_t>(a)] = problem.contact(a).law != ContactLaw::kReleased;
    problem.contact(a).slip.setZero();
  }
  for (int round = 0; round <= problem.count(); ++round) {
    stick_active(problem, active);
    const int pulling = strongest_pull(problem, active);
    if (pulling < 0) break;
    active[static_cast<std::size_t>(pulling)] = false;
  }
  bool sticks = true;
  for (int a = 0; a < problem.count(); ++a) {
    ContactConstraint& contact = problem.contact(a);
    const bool on = active[static_cast<std::size_t>(a)];
    contact.mode = on ? ContactMode::kSticking : ContactMode::kOpen;
    if (on && !inside_cone(contact)) sticks = false;
    // A point that was let go must be left alone by the others, unless friction is without bound:
    // then a point that would have to be pulled sideways lets go.
    if (!on && contact.law != ContactLaw::kReleased && !std::isinf(contact.friction.static_) &&
        (contact.gap - moved(problem, a)).dot(contact.normal) < 0) {
      sticks = false;
    }
  }
  if (sticks) return true;
  for (int a = 0; a < problem.count(); ++a) {
    problem.contact(a).force = start[static_cast<std::size_t>(a)];
  }
  return false;
}

void ContactSolver::start(const ContactProblem& problem) noexcept {
  now_.setZero();
  auto u = now_.segment(6, 3 * problem.count());
  for (int b = 0; b < problem.count(); ++b) {
    const ContactConstraint& contact = problem.contact(b);
    if (contact.force.isZero(0.0)) continue;
    u.noalias() += problem.elastic_column(b) * contact.force;
    push() += contact.force;
    turn() += contact.arm.cross(contact.force);
  }
  direction_.setZero();
  last_change_ = 0.0;
  restarts_ = 0;
}

// Two tips may hold the same place: a little compliance keeps the block regular. The iteration goes
// on to what the contacts ask for.
void ContactSolver::factor_held(ContactProblem& problem) noexcept {
  held_count_ = 0;
  for (int a = 0; a < problem.count() && held_count_ < kMaxContacts; ++a) {
    if (problem.contact(a).law == ContactLaw::kHeld) {
      held_[static_cast<std::size_t>(held_count_++)] = a;
    }
  }
  if (held_count_ == 0) return;
  const int rows = 3 * held_count_;
  ContactMatrix W = ContactMatrix::Zero(rows, rows);
  double trace = 0.0;
  for (int i = 0; i < held_count_; ++i) {
    const int a = held_[static_cast<std::size_t>(i)];
    for (int j = 0; j < held_count_; ++j) {
      W.block<3, 3>(3 * i, 3 * j) = problem.compliance(a, held_[static_cast<std::size_t>(j)]);
    }
    trace += problem.compliance(a, a).trace();
    for (int b = 0; b < problem.count(); ++b) {
      held_answer_.block<3, 3>(3 * i, 3 * b) = problem.compliance(a, b);
    }
  }
  W.diagonal().array() += kHeldRidge * trace / rows;
  held_block_.compute(W);
  using Columns = Eigen::Matrix<double, Eigen::Dynamic, 3, 0, 3 * kMaxContacts, 3>;
  for (int b = 0; b < problem.count(); ++b) {
    const Columns shared = held_answer_.block(0, 3 * b, rows, 3);
    held_answer_.block(0, 3 * b, rows, 3) = held_block_.solve(shared);
  }
}

Vector3 ContactSolver::displacement(const ContactProblem& problem, int a) const noexcept {
  return now_.segment<3>(6 + 3 * a) + problem.rigid.translation * push() -
         problem.contact(a).arm.cross(problem.rigid.rotation * turn());
}

void ContactSolver::add(ContactProblem& problem, int a, const Vector3& more) noexcept {
  if (more.isZero(0.0)) return;
  ContactConstraint& contact = problem.contact(a);
  contact.force += more;
  const auto columns = problem.elastic_column(a);
  now_.segment(6, 3 * problem.count()) +=
      more.x() * columns.col(0) + more.y() * columns.col(1) + more.z() * columns.col(2);
  push() += more;
  turn() += contact.arm.cross(more);
}

// Held contacts answer so that they stay where they are.
void ContactSolver::change(ContactProblem& problem, int a, const Vector3& force) noexcept {
  const Vector3 more = force - problem.contact(a).force;
  if (more.isZero(0.0)) return;
  add(problem, a, more);
  problem.contact(a).force = force;
  for (int i = 0; i < held_count_; ++i) {
    add(problem, held_[static_cast<std::size_t>(i)],
        -held_answer_.block<3, 3>(3 * i, 3 * a) * more);
  }
}

void ContactSolver::find_own_compliances(const ContactProblem& problem) noexcept {
  for (int a = 0; a < problem.count(); ++a) {
    Matrix3 W = problem.compliance(a, a);
    for (int i = 0; i < held_count_; ++i) {
      W -= problem.compliance(a, held_[static_cast<std::size_t>(i)]) *
           held_answer_.block<3, 3>(3 * i, 3 * a);
    }
    const auto index = static_cast<std::size_t>(a);
    own_[index] = 0.5 * (W + W.transpose());
    across_[index] = problem.contact(a).normal.dot(W * problem.contact(a).normal);
  }
}

// Returns how far a contact was off [m].
double ContactSolver::solve_held(ContactProblem& problem) noexcept {
  DirectVector off(3 * held_count_);
  double largest = 0.0;
  for (int i = 0; i < held_count_; ++i) {
    const int a = held_[static_cast<std::size_t>(i)];
    problem.contact(a).mode = ContactMode::kSticking;
    problem.contact(a).slip.setZero();
    off.segment<3>(3 * i) = problem.contact(a).gap - displacement(problem, a);
    largest = std::max(largest, off.segment<3>(3 * i).norm());
  }
  const DirectVector step = held_block_.solve(off);
  for (int i = 0; i < held_count_; ++i) {
    add(problem, held_[static_cast<std::size_t>(i)], step.segment<3>(3 * i));
  }
  return largest;
}

// A contact without friction: one number.
double ContactSolver::solve_smooth(ContactProblem& problem, int a) noexcept {
  ContactConstraint& contact = problem.contact(a);
  const Vector3& normal = contact.normal;
  const double across = across_[static_cast<std::size_t>(a)];
  // One that began with friction may have a force sideways.
  const Vector3 lost = own_[static_cast<std::size_t>(a)] * sideways(contact.force, normal);
  const double open = normal.dot(contact.gap - displacement(problem, a) + lost);
  const double force = normal.dot(contact.force);
  const double needed = std::min(force + open / across, 0.0);  // NaN stays
  contact.mode = needed < 0.0 ? ContactMode::kSlipping : ContactMode::kOpen;
  change(problem, a, needed * normal);
  return std::abs(needed - force) * across + lost.norm();
}

// ... whose slip nobody asks for before the end.
void ContactSolver::find_slips(ContactProblem& problem) noexcept {
  for (int a = 0; a < problem.count(); ++a) {
    ContactConstraint& contact = problem.contact(a);
    if (!is_smooth(contact)) continue;
    contact.slip.setZero();
    if (contact.mode == ContactMode::kOpen) continue;
    contact.slip = sideways(contact.gap - displacement(problem, a), contact.normal);
  }
}

double ContactSolver::solve_touching(ContactProblem& problem, int a) noexcept {
  ContactConstraint& contact = problem.contact(a);
  if (is_smooth(contact)) return solve_smooth(problem, a);
  const Matrix3& W = own_[static_cast<std::size_t>(a)];
  const Vector3 own = contact.gap - displacement(problem, a) + W * contact.force;
  const SingleContact found =
      solve_single_contact(W, own, contact.law, contact.normal, contact.friction);
  const double off = (W * (found.force - contact.force)).norm();
  contact.mode = found.mode;
  contact.slip = found.slip;
  // As from step to step: were it to stick and slip in turns, the sweeps would not end.
  if (found.mode == ContactMode::kSlipping) contact.friction.static_ = contact.friction.kinetic;
  change(problem, a, found.force);
  return off;
}

double ContactSolver::solve_group_friction(ContactProblem& problem, int a) noexcept {
  ContactConstraint& contact = problem.contact(a);
  Vector3 pressed = Vector3::Zero();
  for (int i = 0; i < contact.group_count; ++i) {
    pressed += problem.contact(contact.group_first + i).force;
  }
  const Matrix3& W = own_[static_cast<std::size_t>(a)];
  const Vector3 own = contact.gap - displacement(problem, a) + W * contact.force;
  SingleContact found = irdm::solve_group_friction(W, own, pressed, contact.friction);
  if (found.mode == ContactMode::kSlipping && sweeps_ > kUndampedSweeps) {
    // Friction may press or lift its contacts by more than they yield: else the two go round.
    found.force = 0.5 * (found.force + contact.force);
  }
  const double off = (W * (found.force - contact.force)).norm();
  contact.mode = found.mode;
  contact.slip = found.slip;
  if (found.mode == ContactMode::kSlipping) contact.friction.static_ = contact.friction.kinetic;
  change(problem, a, found.force);
  return off;
}

double ContactSolver::sweep(ContactProblem& problem) noexcept {
  double largest = held_count_ > 0 ? solve_held(problem) : 0.0;
  int held = 0;
  for (int a = 0; a < problem.count(); ++a) {
    ContactConstraint& contact = problem.contact(a);
    if (contact.law == ContactLaw::kGiven) {
      contact.mode = ContactMode::kSticking;
    } else if (contact.law == ContactLaw::kGroupFriction) {
      largest = std::max(largest, solve_group_friction(problem, a));
    } else if (contact.law != ContactLaw::kHeld || held++ >= held_count_) {
      largest = std::max(largest, solve_touching(problem, a));
    }
  }
  return largest;
}

// The forces, beside what they do.
void ContactSolver::keep(const ContactProblem& problem) noexcept {
  auto force = now_.segment(6 + 3 * problem.count(), 3 * problem.count());
  for (int a = 0; a < problem.count(); ++a) force.segment<3>(3 * a) = problem.contact(a).force;
}

// After a sweep, whose change is the residual of the conjugate gradients. Everything is linear in
// the forces, so what they do is carried along.
void ContactSolver::extrapolate(ContactProblem& problem) noexcept {
  keep(problem);
  const int rows = 3 * problem.count();
  auto now = now_.head(6 + 2 * rows);
  auto before = before_.head(6 + 2 * rows);
  auto direction = direction_.head(6 + 2 * rows);
  const double change = (now.tail(rows) - before.tail(rows)).squaredNorm();
  const double beta = change / std::exchange(last_change_, change);
  if (beta <= 1.0) {
    before = now - before;
    direction *= beta;
    now += direction;
    direction += before;
    for (int a = 0; a < problem.count(); ++a) {
      problem.contact(a).force = now.segment<3>(6 + rows + 3 * a);
    }
  } else {
    direction.setZero();  // it begins anew
    if (std::isfinite(beta)) {
      ++restarts_;
    } else {
      direction = now - before;
    }
  }
}

ContactSolution ContactSolver::iterate(ContactProblem& problem,
                                       const SolverLimits& limits) noexcept {
  for (int a = 0; a < problem.count(); ++a) {
    ContactConstraint& contact = problem.contact(a);
    if (is_smooth(contact)) contact.force -= sideways(contact.force, contact.normal);
  }
  start(problem);
  factor_held(problem);
  find_own_compliances(problem);
  ContactSolution solution;
  while (solution.sweeps < limits.max_sweeps) {
    if (solution.sweeps > 0 && restarts_ <= limits.restarts) extrapolate(problem);
    keep(problem);
    const int used = 6 + 6 * problem.count();
    before_.head(used) = now_.head(used);
    sweeps_ = ++solution.sweeps;
    solution.residual = sweep(problem);
    const double enough = solution.sweeps < limits.usual_sweeps ? limits.tolerance : limits.usual;
    if (!(solution.residual > enough)) break;
  }
  find_slips(problem);
  solution.solved = solution.residual <= limits.worst;
  return solution;
}

}  // namespace irdm
